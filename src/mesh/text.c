// Words and numbers of a text.
#include "mesh/text.h"

#include "base/number.h"

#include <ctype.h>
#include <math.h>

static bool is_space(char c)
{
    return isspace((unsigned char)c);
}

void skip_space(text *in)
{
    for (; in->at < in->end && is_space(*in->at); in->at++) in->line += *in->at == '\n';
}

// The length of a backslash with the line end behind it, else 0.
static int continuation(const text *in)
{
    const char *at = in->at;
    if (at == in->end || *at++ != '\\') return 0;
    if (at < in->end && *at == '\r') at++;
    return at < in->end && *at == '\n' ? (int)(at + 1 - in->at) : 0;
}

void skip_blanks(text *in)
{
    for (;;) {
        int length = continuation(in);
        in->line += length > 0;
        in->at += length;
        if (length > 0) continue;
        if (in->at == in->end || *in->at == '\n' || !is_space(*in->at)) return;
        in->at++;
    }
}

void skip_line(text *in)
{
    while (in->at < in->end && *in->at != '\n') {
        int length = continuation(in);
        in->line += length > 0;
        in->at += length ? length : 1;
    }
}

bool next_line(text *in)
{
    skip_line(in);
    for (;;) {
        skip_space(in);
        if (in->at == in->end) return false;
        if (*in->at != '#') return true;
        while (in->at < in->end && *in->at != '\n') in->at++;
    }
}

bool take_word(text *in, char *word, size_t room)
{
    skip_space(in);
    size_t length = 0;
    for (; in->at < in->end && !is_space(*in->at); in->at++)
        if (length + 1 < room) word[length++] = (char)tolower((unsigned char)*in->at);
    word[length] = 0;
    return length > 0;
}

bool take_number(text *in, double *value)
{
    skip_blanks(in);
    return read_decimal(&in->at, in->end, value);
}

bool take_whole(text *in, int64_t *value)
{
    skip_blanks(in);
    const char *at = in->at;
    bool minus = at < in->end && *at == '-';
    if (at < in->end && (*at == '-' || *at == '+')) at++;
    const char *digits = at;
    int64_t number = 0;
    for (; at < in->end && *at >= '0' && *at <= '9'; at++)
        number = MIN(number, INT64_MAX / 10 - 1) * 10 + (*at - '0');
    if (at == digits) return false;
    *value = minus ? -number : number;
    in->at = at;
    return true;
}

bool take_point(text *in, double point[3])
{
    for (int k = 0; k < 3; k++) {
        double value;
        if (!take_number(in, &value) || !isfinite((float)value)) return false;
        point[k] = (float)value;
    }
    return true;
}
