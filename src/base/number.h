// Decimal numbers in files: exact both ways and free of the locale.
#ifndef BASE_NUMBER_H
#define BASE_NUMBER_H

#include "base/base.h"

enum { DECIMAL_BYTES = 32 }; // room for the longest text of write_decimal

/// Read a decimal number ("-12.5e-3") at *at, correctly rounded, and move *at behind it.
/// False when there is none, or it is not finite; *at is then unmoved.
bool read_decimal(const char **at, const char *end, double *value);

/// Write a finite number in the fewest digits that read back the same: a float32 value as read into a
/// float32, any other as read into a double. Returns the length, no end mark.
int write_decimal(char text[DECIMAL_BYTES], double value);

/// Write a whole number >= 0. Returns the length, no end mark.
int write_whole(char *text, uint64_t value);

#endif
