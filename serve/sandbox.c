// A process shuts itself in: limits of the system, then a filter of system calls (seccomp).
//
// How:     a list of what computing needs; everything else ends the process. Threads exist before, so that
// none
//          can be made; files are read and libraries loaded before. mmap and mprotect may not make code.
// Limits:  x86-64 and aarch64. Under a sanitizer the address space has no limit, and what its runtime needs
// is
//          allowed as well.
// Source:  Linux, Documentation/userspace-api/seccomp_filter.rst.
// Checked: tests/test_serve.c: a job that opens a file, a socket, a process, makes code, sends a signal.
#include "sandbox.h"

#include <errno.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#if defined(__x86_64__)
#define OWN_ARCHITECTURE AUDIT_ARCH_X86_64
#elif defined(__aarch64__)
#define OWN_ARCHITECTURE AUDIT_ARCH_AARCH64
#endif

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

static bool limit(int resource, uint64_t most)
{
    struct rlimit both = {.rlim_cur = most, .rlim_max = most};
    return setrlimit(resource, &both) == 0;
}

static bool limit_resources(uint64_t most_bytes, uint64_t cpu_seconds)
{
    return limit(RLIMIT_CORE, 0) && limit(RLIMIT_FSIZE, 0) && limit(RLIMIT_NOFILE, 0) &&
           (cpu_seconds == 0 || limit(RLIMIT_CPU, cpu_seconds)) &&
           (most_bytes == 0 || SANITIZED || limit(RLIMIT_AS, most_bytes));
}

#ifdef OWN_ARCHITECTURE

#define LOAD(field)  BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, field))
#define ALLOW        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)
#define KILL         BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS)
#define PERMIT(call) BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (call), 0, 1), ALLOW
#define DENY(call)   /* the caller goes on without it */                                                     \
    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (call), 0, 1), BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSYS)
// Where a third argument with this bit is refused.
#define PERMIT_WITHOUT(call, bit)                                                                            \
    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (call), 0, 4), LOAD(args[2]),                                        \
        BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, (bit), 0, 1), KILL, ALLOW

// The number of a call in the x32 way has a bit of its own, so it is none of these.
static const struct sock_filter program[] = {
    LOAD(arch),
    BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, OWN_ARCHITECTURE, 1, 0),
    KILL,
    LOAD(nr),
    PERMIT(__NR_read),
    PERMIT(__NR_write),
    PERMIT(__NR_futex),
    PERMIT(__NR_munmap),
    PERMIT(__NR_madvise),
    PERMIT(__NR_mremap),
    PERMIT(__NR_brk),
    PERMIT(__NR_sched_yield),
    PERMIT(__NR_clock_gettime),
    PERMIT(__NR_clock_nanosleep),
    PERMIT(__NR_gettimeofday),
    PERMIT(__NR_getrandom),
    PERMIT(__NR_getpid),
    PERMIT(__NR_gettid),
    PERMIT(__NR_getrusage),
    PERMIT(__NR_sched_getaffinity),
    PERMIT(__NR_sysinfo), // qsort
    PERMIT(__NR_rseq),    // a thread that has only just begun
    PERMIT(__NR_set_robust_list),
    PERMIT(__NR_rt_sigprocmask),
    PERMIT(__NR_rt_sigreturn),
    PERMIT(__NR_restart_syscall),
    PERMIT(__NR_exit),
    PERMIT(__NR_exit_group),
#if SANITIZED
    PERMIT(__NR_sigaltstack),
#endif
    DENY(__NR_mbind), // OpenBLAS, of a thread's first buffer: a hint
    PERMIT_WITHOUT(__NR_mmap, PROT_EXEC),
    PERMIT_WITHOUT(__NR_mprotect, PROT_EXEC),
    KILL,
};

static bool filter_calls(void)
{
    struct sock_fprog filter = {.len = sizeof program / sizeof *program,
                                .filter = (struct sock_filter *)program};
    return syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &filter) == 0;
}

#else

static bool filter_calls(void)
{
    errno = ENOSYS;
    return false;
}

#endif

bool enter_sandbox(uint64_t most_bytes, uint64_t cpu_seconds)
{
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_DUMPABLE, 0, 0, 0, 0) == 0 &&
           limit_resources(most_bytes, cpu_seconds) && filter_calls();
}
