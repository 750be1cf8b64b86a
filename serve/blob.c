// Bytes that several hold, and how many there may be.
#include "blob.h"

#include <stdlib.h>
#include <string.h>

static bool take(budget *b, size_t bytes)
{
    size_t held = atomic_load(&b->held);
    do {
        if (bytes > b->most - held) return false;
    } while (!atomic_compare_exchange_weak(&b->held, &held, held + bytes));
    return true;
}

blob *blob_create(budget *b, size_t capacity)
{
    if (!take(b, capacity)) return NULL;
    blob *made = calloc(1, sizeof *made);
    if (made) *made = (blob){.holders = 1, .budget = b, .capacity = capacity};
    if (made && capacity > 0 && !(made->data = malloc(capacity))) {
        free(made);
        made = NULL;
    }
    if (!made) atomic_fetch_sub(&b->held, capacity);
    return made;
}

bool blob_append(blob *b, const void *data, size_t size)
{
    if (size > b->capacity - b->size) {
        size_t wanted = b->size + size, roomy = b->capacity + b->capacity / 2;
        if (wanted < roomy) wanted = roomy;
        if (size > SIZE_MAX / 4 || !take(b->budget, wanted - b->capacity)) return false;
        uint8_t *larger = realloc(b->data, wanted);
        if (!larger) {
            atomic_fetch_sub(&b->budget->held, wanted - b->capacity);
            return false;
        }
        b->data = larger;
        b->capacity = wanted;
    }
    if (size > 0) memcpy(b->data + b->size, data, size);
    b->size += size;
    return true;
}

void blob_fit(blob *b)
{
    uint8_t *smaller = b->size > 0 ? realloc(b->data, b->size) : NULL;
    if (!smaller) return;
    b->data = smaller;
    atomic_fetch_sub(&b->budget->held, b->capacity - b->size);
    b->capacity = b->size;
}

blob *blob_hold(blob *b)
{
    if (b) atomic_fetch_add(&b->holders, 1);
    return b;
}

void blob_let_go(blob *b)
{
    if (!b || atomic_fetch_sub(&b->holders, 1) > 1) return;
    atomic_fetch_sub(&b->budget->held, b->capacity);
    free(b->data);
    free(b);
}
