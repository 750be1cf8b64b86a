// What a profile can say: its keys, where each goes, what is accepted. Internal.
#ifndef PRINTER_FIGURES_H
#define PRINTER_FIGURES_H

#include <jali/printer.h>
#include "base/base.h"

/// A figure by its key in the file.
typedef struct figure_key {
    const char *key;
    size_t offset;      // of its jali_figure in jali_printer
    double least, most; // both are accepted
    const char *unit;
    bool needed; // no profile without it
} figure_key;

/// The printer's own figures, the bed apart, and those of its material; in the order they are written.
const figure_key *figure_keys(int32_t *count);
const figure_key *material_keys(int32_t *count);

static inline jali_figure *figure_of(jali_printer *printer, const figure_key *k)
{
    return (jali_figure *)((char *)printer + k->offset);
}

enum { LARGEST_BED_MM = 100000 };

/// Is everything said that every profile says, and does it fit together?
///   in     name   for sentences
///   fails  `status`, with the sentence
jali_status check_printer(jali_context *ctx, const jali_printer *printer, const char *name,
                          jali_status status);

#endif
