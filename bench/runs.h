// What is measured again and again: the 24 runs of docs/results.md, every picture at 70 and 40 mm for 1000
// px, in proportion for the others; and the pictures on surfaces of docs/results.md and docs/sheet.md.
#ifndef BENCH_RUNS_H
#define BENCH_RUNS_H

#include <jali/place.h>

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

typedef struct surface_run {
    const char *picture;
    double width_mm;
    const char *surface; // %s is the data folder
    jali_placing placing;
} surface_run;

static const surface_run surface_runs[] = {
    {"portrait", 124, "vase:h=326,r=105", JALI_PLACE_WRAP},
    {"plum", 85, "%s/meshes/bunny.obj:up=y,scale=145.2", JALI_PLACE_PROJECT},
    {"monroe-like", 70, "cylinder:r=35.5,h=74", JALI_PLACE_WRAP},
    {"dense", 70, "cylinder:r=35.5,h=90", JALI_PLACE_WRAP},
    {"dense", 70, "%s/meshes/bunny.obj:up=y,scale=145.2", JALI_PLACE_PROJECT},
    {"scenery", 85, "vase:h=200", JALI_PLACE_WRAP},
    {"scenery", 80, "%s/meshes/bunny.obj:up=y,scale=145.2", JALI_PLACE_PROJECT},
};
enum { SURFACE_RUNS = sizeof surface_runs / sizeof *surface_runs };

#endif
