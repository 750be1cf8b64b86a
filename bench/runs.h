// The 24 runs of docs/results.md: every picture at 70 and 40 mm for 1000 px, in proportion for the others.
#ifndef BENCH_RUNS_H
#define BENCH_RUNS_H

typedef struct bench_run {
    const char *name;
    double width_mm;
} bench_run;

enum { BENCH_RUNS = 24 };

static const bench_run bench_runs[BENCH_RUNS] = {
    {"calligraphy", 70}, {"calligraphy", 40}, {"dense", 70},    {"dense", 40},    {"halftone", 70},
    {"halftone", 40},    {"islands", 70},     {"islands", 40},  {"lion", 70},     {"lion", 40},
    {"monroe-like", 70}, {"monroe-like", 40}, {"ornament", 84}, {"ornament", 48}, {"plum", 105},
    {"plum", 60},        {"portrait", 70},    {"portrait", 40}, {"scenery", 120}, {"scenery", 85},
    {"text", 70},        {"text", 40},        {"tree", 80},     {"tree", 56}};

#endif
