// What a line of G-code does.
//
// Source:  the G-code of Marlin and Klipper as PrusaSlicer, OrcaSlicer, Bambu Studio and Cura write it: G0 to
// G3, G20,
//          G21, G28, G90 to G92, M82, M83; their comments ;TYPE: ;WIDTH: ;HEIGHT:, Bambu's "; FEATURE: " and
//          "; LINE_WIDTH: ", and the filament's diameter among the settings.
// Limits:  arcs lie in the XY plane (G17); no G53 to G59, no G68; everything else is passed over. E is
//          relative after M83 and after G91, as the slicers' own viewers take it.
// Checked: tests/test_gcode.c, fuzz/fuzz_gcode.c.
#include "compare/gcode.h"
#include "base/number.h"

#include <ctype.h>
#include <math.h>
#include <strings.h>

static const double FARTHEST_MM = 1e5;
static const double WIDEST_MM = 10; // and highest, of a stroke; the largest nozzles lay 5 mm

machine machine_at_rest(void)
{
    return (machine){.unit_mm = 1};
}

double laid_length(const laid_move *move)
{
    if (move->turn_rad == 0) return hypot(move->to[0] - move->from[0], move->to[1] - move->from[1]);
    return fabs(move->turn_rad) * hypot(move->from[0] - move->centre[0], move->from[1] - move->centre[1]);
}

// --- Comments

// Behind `key` and one of the marks, if the comment begins with them.
static const char *value_of(const char *comment, const char *key, const char *marks)
{
    size_t length = strlen(key);
    if (strncasecmp(comment, key, length) != 0) return NULL;
    const char *at = comment + length;
    while (*at == ' ') at++;
    if (*at && strchr(marks, *at)) return at + 1 + strspn(at + 1, " ");
    return at > comment + length && strchr(marks, ' ') ? at : NULL;
}

static bool has_any(const char *text, const char *const *words)
{
    for (; *words; words++)
        if (strcasestr(text, *words)) return true;
    return false;
}

static laid_kind kind_of(const char *name)
{
    static const char *const others[] = {"skirt",  "brim",  "support", "tower", "custom",
                                         "shield", "purge", "raft",    "prime", NULL};
    static const char *const walls[] = {"gap", "wall", "perimeter", "shell", NULL};
    static const char *const fills[] = {"fill", "skin", "surface", "bridge", "ironing", NULL};
    if (has_any(name, others)) return LAID_OTHERS;
    if (has_any(name, walls)) return LAID_WALL;
    return has_any(name, fills) ? LAID_FILL : LAID_WALL;
}

// A length above 0 and up to `most`, or what was there before.
static void take_length(const char *at, const char *end, double most, double *mm)
{
    double value;
    if (read_decimal(&at, end, &value) && value > 0 && value <= most) *mm = value;
}

static void follow_comment(const char *at, const char *end, machine *m)
{
    const char *value;
    while (*at == ' ' || *at == ';') at++;
    if ((value = value_of(at, "TYPE", ":")) || (value = value_of(at, "feature", ": ")))
        m->kind = kind_of(value);
    else if ((value = value_of(at, "WIDTH", ":")) || (value = value_of(at, "LINE_WIDTH", ":")))
        take_length(value, end, WIDEST_MM, &m->width_mm);
    else if ((value = value_of(at, "HEIGHT", ":")) || (value = value_of(at, "LAYER_HEIGHT", ":")) ||
             (value = value_of(at, "Layer height", ":")))
        take_length(value, end, WIDEST_MM, &m->height_mm);
    else if ((value = value_of(at, "filament_diameter", ":=")))
        take_length(value, end, 20, &m->filament_mm);
}

// --- Commands

// The words of a command: X10.5 Y3 E.2. Letters A to Z; `given` has bit 1 << (letter - 'A').
typedef struct command {
    char letter; // G, M, or 0 for anything else
    int32_t number;
    uint32_t given;
    double value[26];
} command;

static bool has(const command *c, char letter)
{
    return c->given >> (letter - 'A') & 1;
}

static double value_in(const command *c, char letter)
{
    return c->value[letter - 'A'];
}

static void skip_blanks(const char **at)
{
    while (**at == ' ' || **at == '\t') ++*at;
}

// A number as G-code has them, without exponent: in X10E1 the E is the next word.
static bool take_number(const char **at, double *value)
{
    return read_decimal(at, *at + strspn(*at, "+-.0123456789"), value);
}

// A line number and a word like G1; other lines (macros, T0) come out with letter 0.
static bool take_command(const char **at, command *c)
{
    double number;
    skip_blanks(at);
    char letter = (char)toupper((unsigned char)**at);
    if (letter == 'N' && isdigit((unsigned char)(*at)[1])) {
        ++*at;
        take_number(at, &number);
        skip_blanks(at);
        letter = (char)toupper((unsigned char)**at);
    }
    if ((letter != 'G' && letter != 'M') || !isdigit((unsigned char)(*at)[1])) return false;
    ++*at;
    if (!take_number(at, &number) || number > 9999) return false;
    *c = (command){.letter = letter, .number = number == floor(number) ? (int32_t)number : -1};
    return true;
}

static bool moves(const command *c)
{
    return c->letter == 'G' && ((c->number >= 0 && c->number <= 3) || c->number == 92);
}

static jali_status take_words(jali_context *ctx, const lines *line, const char *at, const char *end,
                              command *c)
{
    for (skip_blanks(&at); at < end && *at != ';' && *at != '(' && *at != '*'; skip_blanks(&at)) {
        char letter = (char)toupper((unsigned char)*at);
        double value = 0;
        const char *behind = at + 1;
        bool number = letter >= 'A' && letter <= 'Z' && take_number(&behind, &value);
        bool flag = letter >= 'A' && letter <= 'Z' && (*behind == ' ' || behind == end) && c->number == 28;
        if (!number && !flag)
            return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: \"%.24s\" is no word of a move such as X12.5",
                        line->name, (long long)line->number, at);
        if (strchr("XYZIJR", letter) && fabs(value) > FARTHEST_MM)
            return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: %c%g lies beyond %g m", line->name,
                        (long long)line->number, letter, value, FARTHEST_MM / 1000);
        c->given |= 1u << (letter - 'A');
        c->value[letter - 'A'] = value;
        at = behind;
    }
    return JALI_OK;
}

// G2 (clockwise) and G3: the centre by I and J, or by the radius R.
static bool lay_arc(const command *c, double unit_mm, laid_move *move)
{
    const double full = 2 * M_PI, *from = move->from, *to = move->to;
    bool clockwise = c->number == 2;
    if (has(c, 'R')) {
        double r = value_in(c, 'R') * unit_mm, dx = to[0] - from[0], dy = to[1] - from[1];
        double half = hypot(dx, dy) / 2, rest = r * r - half * half;
        if (half == 0 || rest < -1e-3 * r * r) return false;
        // Left of the chord for a short arc counter-clockwise; a negative radius asks for the long way.
        double away = sqrt(fmax(rest, 0)) / (2 * half) * (clockwise == (r < 0) ? 1 : -1);
        move->centre[0] = (from[0] + to[0]) / 2 - dy * away;
        move->centre[1] = (from[1] + to[1]) / 2 + dx * away;
    } else {
        if (!has(c, 'I') && !has(c, 'J')) return false;
        move->centre[0] = from[0] + value_in(c, 'I') * unit_mm;
        move->centre[1] = from[1] + value_in(c, 'J') * unit_mm;
    }
    double start = atan2(from[1] - move->centre[1], from[0] - move->centre[0]);
    double end = atan2(to[1] - move->centre[1], to[0] - move->centre[0]);
    double turn = end - start;
    if (clockwise && turn >= -1e-9) turn -= full;
    if (!clockwise && turn <= 1e-9) turn += full;
    move->turn_rad = turn;
    return true;
}

static jali_status move_to(jali_context *ctx, const lines *line, const command *c, machine *m,
                           laid_move *laid, bool *lays)
{
    static const char axis[] = "XYZE";
    double target[4], change[4];
    for (int k = 0; k < 4; k++) {
        bool relative = m->relative || (k == 3 && m->relative_e);
        double value = value_in(c, axis[k]) * m->unit_mm;
        target[k] = !has(c, axis[k]) ? m->at[k] : relative ? m->at[k] + value : value;
        change[k] = target[k] - m->at[k];
        if (!(fabs(target[k]) <= 1e9)) // E counts on for ever
            return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: %c comes to %g", line->name,
                        (long long)line->number, axis[k], target[k]);
    }
    *laid = (laid_move){.z_mm = target[2] + m->origin[2], .feed_mm = change[3]};
    for (int k = 0; k < 2; k++) {
        laid->from[k] = m->at[k] + m->origin[k];
        laid->to[k] = target[k] + m->origin[k];
    }
    memcpy(m->at, target, sizeof m->at);
    if (c->number >= 2 && !lay_arc(c, m->unit_mm, laid))
        return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: an arc needs a centre (I, J) or a radius that fits",
                    line->name, (long long)line->number);
    *lays = change[3] > 0 && laid_length(laid) > 0;
    for (int k = 0; k < 2; k++)
        if (fabs(laid->to[k]) > FARTHEST_MM || fabs(laid->z_mm) > FARTHEST_MM ||
            laid_length(laid) > FARTHEST_MM)
            return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: the move ends beyond %g m", line->name,
                        (long long)line->number, FARTHEST_MM / 1000);
    return JALI_OK;
}

// G92: what is here is called so from now on.
static void rename_place(const command *c, machine *m)
{
    static const char axis[] = "XYZE";
    bool all = !has(c, 'X') && !has(c, 'Y') && !has(c, 'Z') && !has(c, 'E');
    for (int k = 0; k < 4; k++) {
        if (!all && !has(c, axis[k])) continue;
        double value = value_in(c, axis[k]) * m->unit_mm;
        if (k < 3) m->origin[k] += m->at[k] - value;
        m->at[k] = value;
    }
}

static void go_home(const command *c, machine *m)
{
    bool all = !has(c, 'X') && !has(c, 'Y') && !has(c, 'Z');
    for (int k = 0; k < 3; k++)
        if (all || has(c, "XYZ"[k])) m->at[k] = m->origin[k] = 0;
}

static void set_mode(const command *c, machine *m)
{
    if (c->letter == 'M' && (c->number == 82 || c->number == 83)) m->relative_e = c->number == 83;
    if (c->letter == 'G' && (c->number == 90 || c->number == 91)) m->relative = c->number == 91;
    if (c->letter == 'G' && (c->number == 20 || c->number == 21)) m->unit_mm = c->number == 20 ? 25.4 : 1;
}

jali_status follow_line(jali_context *ctx, const lines *line, machine *m, laid_move *laid, bool *lays)
{
    jali_status status = JALI_OK;
    const char *at = line->text, *end = line->text + line->length;
    command c;
    *lays = false;
    skip_blanks(&at);
    if (*at == ';') {
        follow_comment(at, end, m);
    } else if (take_command(&at, &c)) {
        if (moves(&c) || (c.letter == 'G' && c.number == 28)) {
            if (line->cut)
                return fail(ctx, JALI_BAD_INPUT, "%s, line %lld: a move of more than %d characters",
                            line->name, (long long)line->number, LINE_BYTES - 1);
            TRY(take_words(ctx, line, at, end, &c));
            if (c.number == 28)
                go_home(&c, m);
            else if (c.number == 92)
                rename_place(&c, m);
            else
                TRY(move_to(ctx, line, &c, m, laid, lays));
        } else
            set_mode(&c, m);
    }
done:
    return status;
}
