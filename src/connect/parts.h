// The solid parts of a picture while they are being joined. Internal to connect.
#ifndef CONNECT_PARTS_H
#define CONNECT_PARTS_H

#include "raster/raster.h"

enum { MOST_IN_FRONT = 16 };

/// A part is a set of runs with one root; runs of laid bridges are appended to those of the picture.
typedef struct parts {
    components c;         // the picture's runs and the labels they began with
    int32_t alive;        // parts left
    int32_t *parent;      // [c.count], union-find; the smallest label of a part is its root
    int64_t *area;        // [c.count], at roots
    int32_t (*box)[4];    // [c.count], at roots: x0, y0, x1, y1 (beyond)
    int32_t *head, *tail; // [c.count], at roots: the list of its runs
    int32_t run_count;    // picture's and bridges' runs
    size_t run_capacity;
    struct part_run {
        int32_t y, x0, x1, next, label, below;
    } * run;             // below: next bridge run in the same row
    int32_t *row_bridge; // [height], first bridge run of the row or -1
    int32_t heap_count, front_count;
    size_t heap_capacity;
    struct part_key {
        int64_t area;
        int32_t root;
    } * heap;                             // smallest area first; stale entries are skipped
    struct part_key front[MOST_IN_FRONT]; // of the queue, taken out of the heap already; the smallest last
} parts;

jali_status parts_create(jali_context *ctx, const jali_bitmap *drawing, parts *p);
void parts_free(jali_context *ctx, parts *p);
/// The label of the white pixel (x, y): its component's, or for a bridge that of where it was laid from.
int32_t label_at(const parts *p, int32_t x, int32_t y);
/// The root of the part with that label.
int32_t root_of_label(parts *p, int32_t label);
/// Take the smallest part (by area, then by label) out of the queue; false: none is left there.
bool smallest_part(parts *p, int32_t *root);
/// Those that come next if nothing changes, `most` at most, and stay in the queue; returns how many.
int32_t next_parts(parts *p, int32_t most, int32_t *root);
/// Give a part a bridge pixel.
jali_status part_add_pixel(jali_context *ctx, parts *p, int32_t root, int32_t label, int32_t x, int32_t y);
/// Make two parts one; returns the root.
int32_t unite_parts(parts *p, int32_t a, int32_t b);
/// Put a part (back) into the queue.
jali_status queue_part(jali_context *ctx, parts *p, int32_t root);

#endif
