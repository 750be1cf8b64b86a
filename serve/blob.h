// Bytes that several hold, and how many there may be.
#ifndef SERVE_BLOB_H
#define SERVE_BLOB_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// How many bytes a kind of thing may take in all. Safe from any thread.
typedef struct budget {
    size_t most;
    atomic_size_t held;
} budget;

/// A block of bytes that goes when the last who holds it lets it go, and then no longer counts.
typedef struct blob {
    atomic_int holders;
    budget *budget;
    size_t size, capacity; // of these, `size` are in use
    uint8_t *data;         // [capacity]
} blob;

/// An empty one with room for `capacity` bytes, held once; NULL: over budget, or no memory.
blob *blob_create(budget *b, size_t capacity);

/// Append; only while one alone holds it. False: over budget, or no memory; it is then as it was.
bool blob_append(blob *b, const void *data, size_t size);

/// Give back the room that is not in use.
void blob_fit(blob *b);

/// Hold it once more; NULL is accepted.
blob *blob_hold(blob *b);
void blob_let_go(blob *b);

#endif
