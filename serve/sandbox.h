// A process shuts itself in.
#ifndef SERVE_SANDBOX_H
#define SERVE_SANDBOX_H

#include <stdbool.h>
#include <stdint.h>

/// Give up everything but memory, clocks, and reading and writing what is open: no file, socket, process,
/// thread or signal from here on, for all threads; an attempt ends the process by SIGSYS. Nothing of it can
/// be taken back.
///   in     most_bytes    of address space; 0 = no limit
///          cpu_seconds   of all threads together; 0 = no limit
///   out    comes back false, and errno says why, when the kernel refuses: then nothing may be run
bool enter_sandbox(uint64_t most_bytes, uint64_t cpu_seconds);

#endif
