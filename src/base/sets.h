// Disjoint sets in an array of parents: parent[i] == i at a root. Internal.
#ifndef BASE_SETS_H
#define BASE_SETS_H

#include <stdint.h>

static inline int32_t root_of(int32_t *parent, int32_t i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

/// Make two sets one. The lower index is the root, whatever the order of the unions: a set is known by its
/// first member.
static inline void unite(int32_t *parent, int32_t i, int32_t j)
{
    i = root_of(parent, i);
    j = root_of(parent, j);
    if (i < j)
        parent[j] = i;
    else
        parent[i] = j;
}

#endif
