// Of the test build alone: a job that tries what it may not, so that tests see what comes of it.
#ifndef SERVE_HOOKS_H
#define SERVE_HOOKS_H

#include <fcntl.h>
#include <jansson.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

static void run_hook(json_t *asked)
{
    const char *hook = json_string_value(json_object_get(asked, "hook"));
    if (!hook) return;
    if (strcmp(hook, "open") == 0) (void)!open("/etc/passwd", O_RDONLY);
    if (strcmp(hook, "socket") == 0) (void)!socket(AF_INET, SOCK_STREAM, 0);
    if (strcmp(hook, "process") == 0) (void)!syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0);
    if (strcmp(hook, "exec") == 0) execl("/bin/true", "true", (char *)NULL);
    if (strcmp(hook, "signal") == 0) kill(getppid(), SIGTERM);
    if (strcmp(hook, "code") == 0)
        mmap(NULL, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (strcmp(hook, "crash") == 0) __builtin_trap();
    if (strcmp(hook, "spin") == 0)
        for (;;) __asm__ volatile("");
    if (strcmp(hook, "lie") == 0) { // a frame no server may believe
        static const uint32_t head[4] = {5, 255, 0xffffffff, 0xffffffff};
        (void)!write(STDOUT_FILENO, head, sizeof head);
        pause();
    }
}

#endif
