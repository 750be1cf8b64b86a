// Words that people type.
#include "base/words.h"

// Edits (insert, drop, change, each 1) from one word to another.
static int32_t edits_between(const char *a, const char *b)
{
    enum { LONGEST = 40 };
    int32_t row[LONGEST + 1], a_length = (int32_t)strlen(a), b_length = (int32_t)strlen(b);
    if (a_length > LONGEST || b_length > LONGEST) return LONGEST;
    for (int32_t j = 0; j <= b_length; j++) row[j] = j;
    for (int32_t i = 1; i <= a_length; i++) {
        int32_t diagonal = row[0];
        row[0] = i;
        for (int32_t j = 1; j <= b_length; j++) {
            int32_t above = row[j], changed = diagonal + (a[i - 1] != b[j - 1]);
            row[j] = MIN(changed, MIN(above, row[j - 1]) + 1);
            diagonal = above;
        }
    }
    return row[b_length];
}

const char *nearest_name(const char *typed, const char *const *name, int32_t count)
{
    const char *best = NULL;
    int32_t fewest = (int32_t)strlen(typed) / 3 + 2;
    for (int32_t i = 0; i < count; i++) {
        int32_t edits = edits_between(typed, name[i]);
        if (edits < fewest) {
            fewest = edits;
            best = name[i];
        }
    }
    return best;
}
