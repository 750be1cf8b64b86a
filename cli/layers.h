// What a run found, layer by layer: pictures and meshes that a program lays over one another.
#ifndef CLI_LAYERS_H
#define CLI_LAYERS_H

#include "cli.h"

/// One of them; which there are is in layers.c and docs/serve.md.
typedef struct layer {
    const char *name; // of its file
    bool details;     // needs jali_optimise_options.details
    jali_status (*bytes)(jali_context *ctx, const made *m, jali_bytes *bytes);
} layer;

const layer *layer_list(int32_t *count);

/// Does one of these, as settings.layers has them, need the details kept?
bool layers_need_details(uint32_t chosen);

/// The place of a name in the list; -1: there is no such layer.
int32_t layer_named(const char *name);

#endif
