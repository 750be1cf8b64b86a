// What a calibration found, as sentences and as figures of a profile.
#include <jali/calibrate.h>

#include "base/bytes.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

static void set_figure(jali_figure *figure, double value, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static void set_figure(jali_figure *figure, double value, const char *format, ...)
{
    va_list arguments;
    memset(figure, 0, sizeof *figure);
    figure->value = value;
    va_start(arguments, format);
    vsnprintf(figure->source, sizeof figure->source, format, arguments);
    va_end(arguments);
}

// To a ten-thousandth: what follows is noise, and the file is read by people.
static double rounded(double value)
{
    return round(value * 1e4) / 1e4;
}

static jali_status apply_error(jali_context *ctx, const jali_fitted *f, const char *what, const char *from,
                               jali_figure *phi_e, jali_figure *spread)
{
    if (f->kept == 0) {
        if (*phi_e->source) return JALI_OK;
        return fail(
            ctx, JALI_NO_RESULT,
            "%d %s bars that printed are too few for a profile: 3 are needed, or --printer NAME with a "
            "profile to begin with",
            f->measured, what);
    }
    set_figure(phi_e, rounded(f->value),
               "measured from %.120s on %d bars, spread %.3f mm, standard error %.3f mm", from, f->kept,
               f->spread, f->error_mm);
    set_figure(spread, rounded(f->spread), "measured from %.120s on %d bars", from, f->kept);
    return JALI_OK;
}

static jali_status apply_limit(jali_context *ctx, const jali_limit *limit, const char *what,
                               const char *option, const char *from, jali_figure *phi)
{
    if (limit->bounded)
        set_figure(phi, limit->value_mm,
                   "measured from %.120s: it printed with all wider ones, %g mm did not", from,
                   limit->lost_mm);
    else if (limit->found)
        set_figure(phi, limit->value_mm, "at most: the narrowest on the board of %.120s printed", from);
    else if (limit->lost_mm > 0)
        return fail(
            ctx, JALI_NO_RESULT,
            "the widest %s bar, %g mm, did not print: what does is at least wider than that; print a board "
            "for wider ones (jali board %s)",
            what, limit->lost_mm, option);
    else if (!*phi->source)
        return fail(
            ctx, JALI_NO_RESULT,
            "no %s bar was measured, and a profile needs the narrowest that prints: give some, or --printer "
            "NAME with a profile to begin with",
            what);
    return JALI_OK;
}

static jali_status check_together(jali_context *ctx, const jali_printer *p)
{
    double bar = p->phi_s_mm.value + p->phi_e_solid_mm.value,
           slot = p->phi_v_mm.value - p->phi_e_void_mm.value;
    if (bar > 0 && slot > 0) return JALI_OK;
    return fail(
        ctx, JALI_NO_RESULT,
        "a contradiction: the narrowest %s that prints, %g mm, would come out %g mm wide; are the widths of "
        "bars that are gone given as 0 or -?",
        bar > 0 ? "void" : "solid", bar > 0 ? p->phi_v_mm.value : p->phi_s_mm.value, bar > 0 ? slot : bar);
}

jali_status jali_calibration_apply(jali_context *ctx, const jali_calibration *c, const char *from,
                                   jali_printer *printer)
{
    jali_status status;
    jali_printer p = *printer;
    TRY(apply_error(ctx, &c->phi_e_solid, "solid", from, &p.phi_e_solid_mm, &p.phi_e_solid_spread_mm));
    TRY(apply_error(ctx, &c->phi_e_void, "void", from, &p.phi_e_void_mm, &p.phi_e_void_spread_mm));
    TRY(apply_limit(ctx, &c->phi_s, "solid", "--phi-s", from, &p.phi_s_mm));
    TRY(apply_limit(ctx, &c->phi_v, "void", "--phi-v", from, &p.phi_v_mm));
    if (c->hole.kept > 0)
        set_figure(&p.hole_mm2, rounded(c->hole.value), "measured from %.120s on %d holes, spread %.3f mm",
                   from, c->hole.kept, c->hole.spread);
    if (c->corner_mm > 0)
        set_figure(&p.corner_mm, rounded(c->corner_mm), "measured from %.120s on %d corners", from,
                   c->corners);
    TRY(check_together(ctx, &p));
    *printer = p;
done:
    return status;
}

static jali_status tell_error(jali_context *ctx, const jali_fitted *f, const char *what, const char *change,
                              jali_bytes *text)
{
    jali_status status;
    const char *other = strcmp(change, "wider") == 0 ? "narrower" : "wider";
    if (f->kept == 0) {
        if (f->measured == 0) return JALI_OK;
        return bytes_print(ctx, text, "%d %s that printed: too few to tell their error.\n", f->measured,
                           what);
    }
    TRY(bytes_print(ctx, text, "%s come out %.3f mm %s than drawn (spread %.3f mm, %d measured", what,
                    fabs(f->value), f->value < 0 ? other : change, f->spread, f->measured));
    if (f->kept < f->measured)
        TRY(bytes_print(ctx, text, ", %d too far off to count", f->measured - f->kept));
    TRY(bytes_print(ctx, text, ").\n"));
    if (f->doubtful)
        TRY(bytes_print(
            ctx, text,
            "That is not sure: twice its standard error is %.3f mm, 0.02 mm is trusted; %d of %d were too "
            "far off, a fifth is trusted. Rows or widths of these disagree: measure again, more finely, "
            "under even light.\n",
            2 * f->error_mm, f->measured - f->kept, f->measured));
done:
    return status;
}

static jali_status tell_limit(jali_context *ctx, const jali_limit *limit, const char *what, const char *name,
                              jali_bytes *text)
{
    jali_status status = JALI_OK;
    if (limit->bounded)
        TRY(bytes_print(ctx, text,
                        "%s is %g mm: the narrowest %s that prints with all wider ones; %g mm does not.\n",
                        name, limit->value_mm, what, limit->lost_mm));
    else if (limit->found)
        TRY(bytes_print(ctx, text, "%s is at most %g mm: the narrowest %s of the board prints.\n", name,
                        limit->value_mm, what));
    else if (limit->lost_mm > 0)
        TRY(bytes_print(ctx, text, "%s is above %g mm: the widest %s of the board does not print.\n", name,
                        limit->lost_mm, what));
    if (limit->odd_count > 0) {
        TRY(bytes_print(ctx, text,
                        "Narrower than that, and printed all the same, in one direction at least:"));
        for (int32_t i = 0; i < MIN(limit->odd_count, JALI_ODD_WIDTHS); i++)
            TRY(bytes_print(ctx, text, "%s %g", i ? "," : "", limit->odd_mm[i]));
        TRY(bytes_print(ctx, text, "%s mm.\n", limit->odd_count > JALI_ODD_WIDTHS ? " ..." : ""));
    }
done:
    return status;
}

jali_status jali_calibration_sentences(jali_context *ctx, const jali_calibration *c, jali_bytes *text)
{
    jali_status status;
    TRY(tell_error(ctx, &c->phi_e_solid, "Solid bars", "wider", text));
    TRY(tell_error(ctx, &c->phi_e_void, "Void bars", "narrower", text));
    TRY(tell_limit(ctx, &c->phi_s, "solid bar", "phi_s", text));
    TRY(tell_limit(ctx, &c->phi_v, "void bar", "phi_v", text));
    if (c->hole.kept > 0)
        TRY(bytes_print(
            ctx, text,
            "Round holes of diameter d come out %.4f mm2 / d narrower than bars (spread %.3f mm, %d "
            "measured).\n",
            c->hole.value, c->hole.spread, c->hole.measured));
    TRY(tell_error(ctx, &c->pin, "Pins", "wider", text));
    if (c->corner_mm > 0)
        TRY(bytes_print(ctx, text, "Corners are rounded to %.2f mm (%d measured).\n", c->corner_mm,
                        c->corners));
done:
    return status;
}
