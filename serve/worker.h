// The process that does one job.
#ifndef SERVE_WORKER_H
#define SERVE_WORKER_H

/// `jali work MEMORY_MB CPU_SECONDS THREADS`: one job as frames on stdin, what it makes as frames on stdout.
/// What it is given is hostile; what it could do with that is shut in (sandbox.h). For `jali serve` alone.
int run_worker(int argc, char **argv);

#endif
