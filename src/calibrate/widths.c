// Tables and lists of measured widths.
//
// Limits:  1,000,000 widths.
// Checked: tests/test_calibrate.c; fuzz/fuzz_widths.c.
#include <jali/calibrate.h>

#include "base/number.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <strings.h>

enum { MOST_WIDTHS = 1000000, FIELDS = 4, LISTED_LINES = 10, COMPLAINT_BYTES = 200 };
static const double MOST_MM = 1000;

void jali_widths_free(jali_context *ctx, jali_widths *widths)
{
    release(ctx, widths->width);
    *widths = (jali_widths){0};
}

jali_status jali_widths_add(jali_context *ctx, const jali_width *width, jali_widths *widths)
{
    if (widths->count >= MOST_WIDTHS)
        return fail(ctx, JALI_LIMIT, "more than %d widths are too many", MOST_WIDTHS);
    jali_status status = GROW(ctx, widths->width, widths->capacity, widths->count + 1);
    if (status == JALI_OK) widths->width[widths->count++] = *width;
    return status;
}

// A piece of text, without the blanks around it.
typedef struct field {
    const char *start, *end;
} field;

static field trimmed(const char *start, const char *end)
{
    while (start < end && (*start == ' ' || *start == '\r' || *start == '\t')) start++;
    while (start < end && (end[-1] == ' ' || end[-1] == '\r' || end[-1] == '\t')) end--;
    return (field){start, end};
}

static bool is(field f, const char *word)
{
    size_t length = strlen(word);
    return (size_t)(f.end - f.start) == length && strncasecmp(f.start, word, length) == 0;
}

static int shown(field f)
{
    return (int)MIN(f.end - f.start, 30);
}

static bool complain(char *complaint, const char *format, ...) __attribute__((format(printf, 2, 3)));
static bool complain(char *complaint, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(complaint, COMPLAINT_BYTES, format, arguments);
    va_end(arguments);
    return false;
}

// A number, its decimal comma turned into a point where `comma` allows one.
static bool number_of(field f, bool comma, double *value)
{
    char text[64];
    size_t length = (size_t)(f.end - f.start);
    if (length == 0 || length >= sizeof text) return false;
    for (size_t i = 0; i < length; i++) text[i] = comma && f.start[i] == ',' ? '.' : f.start[i];
    const char *at = text;
    if (!read_decimal(&at, text + length, value)) return false;
    while (at < text + length && *at == ' ') at++;
    return at == text + length || (text + length - at == 2 && strncmp(at, "mm", 2) == 0);
}

static bool read_designed(field f, bool comma, double *value, char *complaint)
{
    if (!number_of(f, comma, value))
        return complain(complaint, "\"%.*s\" is no designed width: a number of mm such as 0.4 is", shown(f),
                        f.start);
    if (!(*value > 0 && *value <= MOST_MM))
        return complain(complaint, "a designed width of %g mm: above 0, up to %g mm is accepted", *value,
                        MOST_MM);
    return true;
}

static bool read_measured(field f, bool comma, double *value, char *complaint)
{
    *value = 0;
    if (f.start == f.end || is(f, "-")) return true;
    if (!number_of(f, comma, value))
        return complain(complaint,
                        "\"%.*s\" is no measured width: a number of mm is, or 0 or - for what did not print",
                        shown(f), f.start);
    if (!(*value >= 0 && *value <= MOST_MM))
        return complain(complaint, "a measured width of %g mm: 0 to %g mm is accepted", *value, MOST_MM);
    return true;
}

static bool read_kind(field f, jali_board_kind *kind, char *complaint)
{
    for (int32_t i = 0; i < JALI_BOARD_KINDS; i++)
        if (is(f, jali_board_kind_name((jali_board_kind)i))) {
            *kind = (jali_board_kind)i;
            return true;
        }
    return complain(complaint, "\"%.*s\" is no kind: solid, void, hole, pin, solid pair and void pair are",
                    shown(f), f.start);
}

static bool read_direction(field f, jali_board_direction *direction, char *complaint)
{
    static const char *const name[] = {"horizontal", "vertical", "diagonal", ""};
    for (int32_t i = 0; i < 4; i++)
        if (is(f, name[i])) {
            *direction = (jali_board_direction)i;
            return true;
        }
    return complain(complaint, "\"%.*s\" is no direction: horizontal, vertical, diagonal or nothing is",
                    shown(f), f.start);
}

// A table's separator: of semicolon, tab and comma the first that it has.
static char separator_of(const char *start, const char *end)
{
    if (memchr(start, ';', (size_t)(end - start))) return ';';
    if (memchr(start, '\t', (size_t)(end - start))) return '\t';
    return ',';
}

static int32_t split(field line, char separator, field part[FIELDS + 1])
{
    int32_t count = 0;
    for (const char *from = line.start;; from++) {
        const char *to = memchr(from, separator, (size_t)(line.end - from));
        if (!to) to = line.end;
        if (count <= FIELDS) part[count] = trimmed(from, to);
        count++;
        if (to == line.end) return count;
        from = to;
    }
}

static bool read_row(field line, char separator, jali_width *width, char *complaint)
{
    field part[FIELDS + 1];
    int32_t count = split(line, separator, part);
    bool comma = separator != ',';
    if (count < 3)
        return complain(complaint, "%d field%s: designed,measured,kind are needed", count,
                        count == 1 ? "" : "s");
    if (count > FIELDS)
        return complain(complaint, "%d fields, 3 or 4 are accepted%s", count,
                        comma ? "" : " (decimal commas need semicolons between the fields)");
    width->direction = JALI_BOARD_ROUND;
    return read_designed(part[0], comma, &width->designed_mm, complaint) &&
           read_measured(part[1], comma, &width->measured_mm, complaint) &&
           read_kind(part[2], &width->kind, complaint) &&
           (count < 4 || read_direction(part[3], &width->direction, complaint));
}

static bool is_header(field line, char separator)
{
    static const char *const name[FIELDS] = {"designed", "measured", "kind", "direction"};
    field part[FIELDS + 1];
    int32_t count = split(line, separator, part);
    if (count < 3 || count > FIELDS) return false;
    for (int32_t i = 0; i < count; i++)
        if (!is(part[i], name[i])) return false;
    return true;
}

// The lines that cannot be read; the first with its reason.
typedef struct complaints {
    int32_t count, line[LISTED_LINES];
    char first[COMPLAINT_BYTES];
} complaints;

static jali_status report(jali_context *ctx, const complaints *c, const char *name)
{
    char others[LISTED_LINES * 12] = "";
    size_t used = 0;
    for (int32_t i = 1; i < MIN(c->count, LISTED_LINES); i++)
        used += (size_t)snprintf(others + used, sizeof others - used, "%s %d", i == 1 ? "" : ",", c->line[i]);
    if (c->count == 0) return JALI_OK;
    return fail(ctx, JALI_BAD_INPUT, "%.100s, line %d: %s%s%s%s", name, c->line[0], c->first,
                c->count > 1 ? "; neither can be read:" : "", others, c->count > LISTED_LINES ? " ..." : "");
}

jali_status jali_widths_read(jali_context *ctx, const uint8_t *bytes, size_t size, const char *name,
                             jali_widths *widths)
{
    jali_status status = JALI_OK;
    const char *at = (const char *)bytes, *end = at + size;
    complaints wrong = {0};
    size_t before = widths->count;
    if (size >= 3 && memcmp(at, "\xef\xbb\xbf", 3) == 0) at += 3; // a byte order mark, as spreadsheets write
    char separator = separator_of(at, end);
    bool header = true;
    for (int32_t number = 1; at < end; number++) {
        const char *stop = memchr(at, '\n', (size_t)(end - at)), *next = stop ? stop + 1 : end;
        const char *comment = memchr(at, '#', (size_t)(next - at));
        field line = trimmed(at, comment ? comment : stop ? stop : end);
        at = next;
        if (number >= 2 * MOST_WIDTHS) return fail(ctx, JALI_LIMIT, "%.100s has too many lines", name);
        if (line.start == line.end) continue;
        bool names = header && is_header(line, separator);
        header = false;
        if (names) continue;
        jali_width width = {.line = number};
        char complaint[COMPLAINT_BYTES];
        if (read_row(line, separator, &width, complaint)) {
            TRY(jali_widths_add(ctx, &width, widths));
            continue;
        }
        if (wrong.count == 0) memcpy(wrong.first, complaint, sizeof complaint);
        if (wrong.count < LISTED_LINES) wrong.line[wrong.count] = number;
        wrong.count++;
    }
    TRY(report(ctx, &wrong, name));
    if (widths->count == before)
        TRY(fail(ctx, JALI_BAD_INPUT, "%.100s has no widths: lines such as 0.4,0.52,solid are accepted",
                 name));
done:
    if (status != JALI_OK) widths->count = before;
    return status;
}

// kind:designed=measured
static bool read_item(field item, jali_width *width, char *complaint)
{
    size_t length = (size_t)(item.end - item.start);
    const char *colon = memchr(item.start, ':', length), *equals = memchr(item.start, '=', length);
    if (!colon || !equals || equals < colon)
        return complain(complaint, "\"%.*s\" is no width: kind:designed=measured is, such as solid:0.4=0.52",
                        shown(item), item.start);
    return read_kind(trimmed(item.start, colon), &width->kind, complaint) &&
           read_designed(trimmed(colon + 1, equals), false, &width->designed_mm, complaint) &&
           read_measured(trimmed(equals + 1, item.end), false, &width->measured_mm, complaint);
}

jali_status jali_widths_parse(jali_context *ctx, const char *text, jali_widths *widths)
{
    jali_status status = JALI_OK;
    const char *end = text + strlen(text);
    size_t before = widths->count;
    for (int32_t number = 1; text <= end; number++) {
        const char *stop = memchr(text, ',', (size_t)(end - text));
        char complaint[COMPLAINT_BYTES];
        jali_width width = {.line = number, .direction = JALI_BOARD_ROUND};
        if (!stop) stop = end;
        if (!read_item(trimmed(text, stop), &width, complaint))
            TRY(fail(ctx, JALI_BAD_VALUE, "width %d: %s", number, complaint));
        TRY(jali_widths_add(ctx, &width, widths));
        text = stop + 1;
    }
done:
    if (status != JALI_OK) widths->count = before;
    return status;
}
