// A thing described in one word of a command line: `kind:key=value,key=value`.
#ifndef MESH_SPEC_H
#define MESH_SPEC_H

#include "base/base.h"

enum { SPEC_ITEMS = 16 };

typedef struct spec_item {
    const char *key, *value; // not ended by a 0; a value without a key has key_length 0
    int key_length, value_length;
    bool taken;
} spec_item;

typedef struct spec {
    const char *what; // what it describes, in sentences
    int32_t item_count;
    spec_item item[SPEC_ITEMS];
    char accepted[160]; // the keys that were asked for so far
} spec;

/// Split the part behind the colon, which may be empty.
///   in     items  must outlive the spec
///   fails  JALI_BAD_VALUE
jali_status spec_split(jali_context *ctx, const char *what, const char *items, spec *s);

/// Take the number of a key; `value` keeps what it holds when the key is not there.
///   fails  JALI_BAD_VALUE (no number, or outside low .. high)
jali_status spec_number(jali_context *ctx, spec *s, const char *key, double low, double high, double *value);

/// Take the text of a key, or with key "" the value that has none. False when it is not there.
bool spec_text(spec *s, const char *key, const char **text, int *length);

/// Take one of `count` words; `index` keeps what it holds when the key is not there.
///   fails  JALI_BAD_VALUE (another word)
jali_status spec_choice(jali_context *ctx, spec *s, const char *key, const char *const *word, int32_t count,
                        int32_t *index);

/// Refuse what nobody took.
///   fails  JALI_BAD_VALUE
jali_status spec_finish(jali_context *ctx, const spec *s);

#endif
