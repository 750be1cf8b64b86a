// Descriptions of the form key=value,key=value: split once, then asked key by key.
//
// Limits:  a value holds no comma; 16 items.
// Checked: tests/test_surface.c.
#include "mesh/spec.h"

#include "base/number.h"

#include <stdio.h>

jali_status spec_split(jali_context *ctx, const char *what, const char *items, spec *s)
{
    *s = (spec){.what = what};
    for (const char *at = items; *at;) {
        const char *end = at + strcspn(at, ",");
        const char *equals = memchr(at, '=', (size_t)(end - at));
        if (s->item_count == SPEC_ITEMS)
            return fail(ctx, JALI_BAD_VALUE, "%s: more than %d values", what, SPEC_ITEMS);
        if (end == at || equals == at || equals == end - 1)
            return fail(ctx, JALI_BAD_VALUE, "%s: a value is missing near \"%.40s\"", what, at);
        if (end - at > 4096) return fail(ctx, JALI_BAD_VALUE, "%s: a value is too long", what);
        spec_item *item = &s->item[s->item_count++];
        item->key = at;
        item->key_length = equals ? (int)(equals - at) : 0;
        item->value = equals ? equals + 1 : at;
        item->value_length = (int)(end - item->value);
        at = *end ? end + 1 : end;
    }
    return JALI_OK;
}

// The last one given counts.
static spec_item *find(spec *s, const char *key)
{
    spec_item *found = NULL;
    size_t used = strlen(s->accepted);
    snprintf(s->accepted + used, sizeof s->accepted - used, "%s%s", used ? ", " : "", *key ? key : "a name");
    for (int32_t i = 0; i < s->item_count; i++) {
        spec_item *item = &s->item[i];
        if (item->key_length != (int)strlen(key) || memcmp(item->key, key, strlen(key)) != 0) continue;
        item->taken = true;
        found = item;
    }
    return found;
}

jali_status spec_number(jali_context *ctx, spec *s, const char *key, double low, double high, double *value)
{
    const spec_item *item = find(s, key);
    if (!item) return JALI_OK;
    const char *at = item->value, *end = at + item->value_length;
    double number;
    if (!read_decimal(&at, end, &number) || at != end)
        return fail(ctx, JALI_BAD_VALUE, "%s: %s=%.*s is not a number", s->what, key,
                    MIN(item->value_length, 40), item->value);
    if (!(number >= low && number <= high))
        return fail(ctx, JALI_BAD_VALUE, "%s: %s must be %g .. %g, not %g", s->what, key, low, high, number);
    *value = number;
    return JALI_OK;
}

bool spec_text(spec *s, const char *key, const char **text, int *length)
{
    const spec_item *item = find(s, key);
    if (!item) return false;
    *text = item->value;
    *length = item->value_length;
    return true;
}

jali_status spec_choice(jali_context *ctx, spec *s, const char *key, const char *const *word, int32_t count,
                        int32_t *index)
{
    const char *text;
    int length;
    char words[160] = "";
    if (!spec_text(s, key, &text, &length)) return JALI_OK;
    for (int32_t i = 0; i < count; i++) {
        if ((int)strlen(word[i]) == length && memcmp(word[i], text, (size_t)length) == 0) {
            *index = i;
            return JALI_OK;
        }
        size_t used = strlen(words);
        snprintf(words + used, sizeof words - used, "%s%s", i ? ", " : "", word[i]);
    }
    return fail(ctx, JALI_BAD_VALUE, "%s: %s is \"%.*s\"; there are %s", s->what, *key ? key : "the name",
                MIN(length, 40), text, words);
}

jali_status spec_finish(jali_context *ctx, const spec *s)
{
    for (int32_t i = 0; i < s->item_count; i++) {
        const spec_item *item = &s->item[i];
        if (item->taken) continue;
        int length = item->key_length ? item->key_length : item->value_length;
        return fail(ctx, JALI_BAD_VALUE, "%s does not take \"%.*s\"; it takes %s", s->what, MIN(length, 40),
                    item->key, s->accepted);
    }
    return JALI_OK;
}
