// Smallest: the smallest size of a picture at which nothing of it is lost.
#ifndef JALI_SMALLEST_H
#define JALI_SMALLEST_H

#include <jali/jali.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { JALI_MOST_TRIES = 48 };

typedef struct jali_smallest_options {
    double least_mm, most_mm; // widths to try, 0 < least < most <= 10,000 (10, 400)
    double precision;         // the answer is at most so much too large, as a share of it; 0.001 to 1 (0.03)
    int32_t least_px;         // what counts as a detail, as jali_lost_options has it (8)
} jali_smallest_options;

JALI_API jali_smallest_options jali_smallest_defaults(void);

/// One width that was tried.
typedef struct jali_smallest_try {
    double width_mm, pixel_mm;   // pixel_mm: the working pixel; 0 = nothing at all of the picture was left
    jali_lost_tone white, black; // what is lost there
    bool whole;                  // nothing is
    bool coarse;                 // on a grid twice as coarse as a run's own
} jali_smallest_try;

typedef struct jali_smallest {
    double width_mm;     // the answer; 0: something is lost up to the largest width tried
    double confirmed_mm; // a larger width at which nothing is lost either; 0: none was tried
    bool monotone;       // no smaller width was found at which nothing is lost, too
    int32_t try_count;
    jali_smallest_try tried[JALI_MOST_TRIES]; // in the order they were tried
} jali_smallest;

/// Find the smallest width of a plate, from which on nothing of the picture is lost (jali_find_lost). Sizes
/// are tried from the least upwards, each sqrt(2) of the one before, on a grid twice as coarse, until nothing
/// is lost at two in a row; then the gap below the first is halved on the grid that a run would have. What
/// lies between the widths that were tried is not known: a larger width may lose something again, and `tried`
/// says which were looked at.
///   in     opt       NULL means the defaults; threshold, printer, place's frame, and optimise count
///   inout  picture   rewritten by a local threshold only
///   fails  JALI_BAD_VALUE, JALI_BAD_INPUT (one tone), JALI_NO_MEMORY, JALI_LIMIT, JALI_CANCELLED
///   cost   about five times the image stages at the answer
JALI_API jali_status jali_find_smallest(jali_context *ctx, jali_picture *picture, const jali_options *opt,
                                        const jali_smallest_options *range, jali_smallest *smallest);

#ifdef __cplusplus
}
#endif
#endif
