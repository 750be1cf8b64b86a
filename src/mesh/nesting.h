// How shells lie in each other: the winding number around a point of each.
#ifndef MESH_NESTING_H
#define MESH_NESTING_H

#include "mesh/intersect.h"

/// For each closed shell: how often do the other closed shells enclose its first vertex, counted with their
/// orientation? A body in the open has 0, its void 1, a body within that void 0 again.
///   in     t        of the same triangles as s
///   out    winding  [t->shell_count], 0 for flawed shells
///   cost   one vertical ray a shell
void shell_windings(const exact_surface *s, const topology *t, int32_t *winding);

#endif
