// Decimal numbers in files.
//
// Reading:  up to 19 digits and a power of ten both exact in a double need one rounding, which is the correct
//           one (Clinger, How to read floating point numbers accurately, 1990). The rest goes to strtod as
//           whole digits and an exponent, without the point that a locale might spell otherwise.
// Checked:  tests/test_model.c against strtod; tests/test_write.c reads back random float32 and doubles.
#include "base/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double power_of_ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                      1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
enum { EXACT_POWERS = 22 };

static bool is_digit(const char *at, const char *end)
{
    return at < end && *at >= '0' && *at <= '9';
}

// The exponent behind an e, held within what any double can use; without digits the e is not part of the
// number.
static const char *read_exponent(const char *at, const char *end, int32_t *exponent)
{
    *exponent = 0;
    if (at == end || (*at | 32) != 'e') return at;
    const char *digits = at + 1;
    bool minus = digits < end && *digits == '-';
    if (digits < end && (*digits == '-' || *digits == '+')) digits++;
    if (!is_digit(digits, end)) return at;
    for (; is_digit(digits, end); digits++) *exponent = MIN(*exponent * 10 + (*digits - '0'), 99999);
    if (minus) *exponent = -*exponent;
    return digits;
}

static double slow_decimal(const char *digits, const char *end, int64_t exponent)
{
    // 800 digits decide every double (Steele and White); what follows cannot change the result but for being
    // there, which a last 1 stands for.
    enum { DIGITS = 800 };
    char text[DIGITS + 32];
    int length = 0;
    bool rest = false;
    for (; digits < end && (*digits == '.' || is_digit(digits, end)); digits++) {
        if (*digits == '.') continue;
        if (length == 0 && *digits == '0') continue;
        if (length < DIGITS)
            text[length++] = *digits;
        else {
            rest |= *digits != '0';
            exponent++;
        }
    }
    if (length == 0) return 0;
    if (rest) text[length - 1] = (char)MAX(text[length - 1], '1');
    snprintf(text + length, 32, "e%lld", (long long)exponent);
    return strtod(text, NULL);
}

bool read_decimal(const char **at, const char *end, double *value)
{
    const char *here = *at;
    bool minus = here < end && *here == '-';
    if (here < end && (*here == '-' || *here == '+')) here++;
    const char *digits = here;
    uint64_t whole = 0;
    int64_t scale = 0;
    int32_t significant = 0;
    bool point = false, any = false;
    for (; here < end; here++) {
        if (*here == '.' && !point) {
            point = true;
            continue;
        }
        if (!is_digit(here, end)) break;
        any = true;
        if (significant < 19) whole = whole * 10 + (uint64_t)(*here - '0');
        if (whole || significant) significant++;
        scale -= point;
    }
    if (!any) return false;
    const char *digits_end = here;
    int32_t exponent;
    here = read_exponent(here, end, &exponent);
    scale += exponent;
    double result;
    if (significant <= 19 && whole <= (uint64_t)1 << 53 && scale >= -EXACT_POWERS && scale <= EXACT_POWERS)
        result = scale < 0 ? (double)whole / power_of_ten[-scale] : (double)whole * power_of_ten[scale];
    else
        result = slow_decimal(digits, digits_end, scale);
    if (!isfinite(result)) return false;
    *value = minus ? -result : result;
    *at = here;
    return true;
}

int write_whole(char *text, uint64_t value)
{
    char reversed[20];
    int length = 0, written = 0;
    do reversed[length++] = (char)('0' + value % 10);
    while (value /= 10);
    while (length > 0) text[written++] = reversed[--length];
    return written;
}

// whole + decimals / 10^places, without the zeros at the end.
static int write_fixed(char *text, uint64_t whole, uint64_t decimals, int places)
{
    int length = write_whole(text, whole);
    if (decimals == 0) return length;
    for (; decimals % 10 == 0; decimals /= 10) places--;
    text[length] = '.';
    for (int i = places; i > 0; i--, decimals /= 10) text[length + i] = (char)('0' + decimals % 10);
    return length + 1 + places;
}

// A float32 of ordinary size: six to nine significant digits, the first that lies within half a step of it.
static int write_float(char *text, double value)
{
    double step = value - (double)nextafterf((float)value, 0);
    int places = 5 - (int)floor(log10(value));
    for (int i = 0; i < 4; i++, places++) {
        if (places < 0 || places > 15) continue;
        double digits = nearbyint(value * power_of_ten[places]);
        if (digits > 9e15 || fabs(digits / power_of_ten[places] - value) >= 0.499 * step) continue;
        uint64_t all = (uint64_t)digits, unit = (uint64_t)power_of_ten[places];
        return write_fixed(text, all / unit, all % unit, places);
    }
    return 0;
}

// A number that people wrote: the few decimals that stand for it. Both are below 2^53 and a power of ten that
// is exact, so their quotient is what read_decimal reads.
static int write_plain(char *text, double value)
{
    enum { MOST_PLACES = 9 };
    for (int places = 1; places <= MOST_PLACES; places++) {
        double digits = nearbyint(value * power_of_ten[places]);
        if (digits > 9e15 || digits / power_of_ten[places] != value) continue;
        uint64_t all = (uint64_t)digits, unit = (uint64_t)power_of_ten[places];
        return write_fixed(text, all / unit, all % unit, places);
    }
    return 0;
}

static int write_by_printf(char text[DECIMAL_BYTES], double value)
{
    bool single = value == (double)(float)value;
    int length = 0;
    for (int digits = single ? 6 : 15; digits <= (single ? 9 : 17); digits++) {
        length = snprintf(text, DECIMAL_BYTES, "%.*e", digits - 1, value);
        for (int i = 0; i < length; i++)
            if (!(text[i] >= '0' && text[i] <= '9') && text[i] != 'e' && text[i] != '-' && text[i] != '+')
                text[i] = '.';
        const char *at = text;
        double back;
        if (!read_decimal(&at, text + length, &back)) continue;
        if (single ? (float)back == (float)value : back == value) break;
    }
    return length;
}

int write_decimal(char text[DECIMAL_BYTES], double value)
{
    int length = 0;
    double magnitude = fabs(value);
    if (value < 0) text[length++] = '-';
    if (magnitude < 1e15 && magnitude == floor(magnitude))
        return length + write_whole(text + length, (uint64_t)magnitude);
    if (magnitude == (double)(float)magnitude && magnitude > 1e-4 && magnitude < 16777216) {
        int written = write_float(text + length, magnitude);
        if (written) return length + written;
    }
    int written = write_plain(text + length, magnitude);
    if (written) return length + written;
    return write_by_printf(text, value);
}
