// The search's state, and one disc on trial. Internal to adapt.
#ifndef ADAPT_TRIAL_H
#define ADAPT_TRIAL_H

#include "adapt/local.h"
#include "adapt/widths.h"

#include <jali/adapt.h>
#include <stdatomic.h>

// A tone's side of the search.
typedef struct tone {
    jali_bitmap axis; // of the details of this tone
    jali_bitmap open; // places of the axis that are still worth a try
    jali_bitmap fits; // centres at which the disc fits into the print's pixels of this tone
    const field *disc;
    window_field local;
    window_element fit; // flat: the disc everywhere
    window blocked; // flat: centres of the other tone's discs that meet this disc set in the window's middle
} tone;

// A disc to try.
typedef struct trial {
    int32_t x, y;
    bool white;
    const window_patch *disc;
    int64_t worth[2]; // [white], of a lost pixel of an axis here; a wrong pixel counts WRONG_UNITS
} trial;

typedef struct stamping {
    const jali_adapt_options *opt;
    jali_bitmap drawing, print; // padded by PAD_PX on each side
    tone side[2];               // [white]
    window inner,
        fits_inner;    // where a change can reach, and where it can change which discs fit; wide windows
    int32_t wide_rows; // of a window that decides which discs fit around a change
    int32_t rows;      // of a window that decides what a disc changes
    int32_t reach, fits_reach; // how far a change reaches, and how far away it changes which discs fit
    int32_t pass, band_count;
    jali_stamp_report *band; // [band_count]
    atomic_int *chunks_done; // [band_count] in this pass
    widths w;
} stamping;

/// The disc of a place. On a curved surface both tones' discs are those of the place.
trial trial_at(const stamping *s, int32_t x, int32_t y, bool white);

/// Try a disc and keep it when the sum falls by more than `least_gain` of its area. Returns whether the place
/// may be worth another try in a later pass: one that would only do harm is not, for what others do around it
/// seldom changes that, and it would be asked again and again.
bool try_disc(stamping *s, jali_stamp_report *report, const trial *t, double least_gain);

/// All but the disc, set in the middle of a window of so many rows.
void draw_rest(const window_patch *disc, int32_t rows, window *rest);

#endif
