// Building the box hierarchy: Morton codes of the centres, a radix sort, boxes bottom-up.
#include "mesh/boxes.h"
#include "base/curve.h"

#include <math.h>

enum { CODE_BITS = 42, DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS }; // 14 bits an axis, four passes

// Cells are cubes, so that a flat plate spends no bits on its thickness alone.
static void morton_codes(int32_t count, const box *items, uint64_t *code)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, extent = 0;
    for (int k = 0; k < 3; k++) {
        double high = -INFINITY;
        for (int32_t i = 0; i < count; i++) {
            double centre = 0.5 * ((double)items[i].low[k] + (double)items[i].high[k]);
            low[k] = MIN(low[k], centre);
            high = MAX(high, centre);
        }
        extent = MAX(extent, high - low[k]);
    }
    double scale = extent > 0 ? 16383.0 / extent : 0;
    for (int32_t i = 0; i < count; i++) {
        code[i] = 0;
        for (int k = 0; k < 3; k++) {
            double centre = 0.5 * ((double)items[i].low[k] + (double)items[i].high[k]);
            code[i] |= every_third_bit((uint64_t)((centre - low[k]) * scale)) << k;
        }
    }
}

// A stable least-digit-first sort of the items by their codes; equal codes keep their order.
static void sort_by_code(int32_t count, const uint64_t *code, int32_t *item, int32_t *spare)
{
    int32_t *from = item, *to = spare;
    for (int32_t i = 0; i < count; i++) item[i] = i;
    for (int shift = 0; shift < CODE_BITS; shift += DIGIT_BITS) {
        int32_t start[DIGITS + 1] = {0};
        for (int32_t i = 0; i < count; i++) start[(code[i] >> shift & (DIGITS - 1)) + 1]++;
        for (int32_t d = 0; d < DIGITS; d++) start[d + 1] += start[d];
        for (int32_t i = 0; i < count; i++) to[start[code[from[i]] >> shift & (DIGITS - 1)]++] = from[i];
        int32_t *swap = from;
        from = to;
        to = swap;
    } // an even number of passes: the result is in `item` again
}

static void set_child(box_node *node, int32_t child, const box *b)
{
    for (int k = 0; k < 3; k++) {
        node->low[k][child] = b->low[k];
        node->high[k][child] = b->high[k];
    }
}

static box union_of_children(const box_node *node)
{
    box all;
    for (int k = 0; k < 3; k++) {
        all.low[k] = INFINITY;
        all.high[k] = -INFINITY;
        for (int32_t i = 0; i < BOX_WIDTH; i++) {
            all.low[k] = MIN(all.low[k], node->low[k][i]);
            all.high[k] = MAX(all.high[k], node->high[k][i]);
        }
    }
    return all;
}

static void fill_levels(box_tree *tree, const box *items)
{
    const box nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    int32_t below = tree->item_count;
    for (int32_t level = 0; level < tree->level_count; level++) {
        int32_t nodes = tree->first[level + 1] - tree->first[level];
        for (int32_t i = 0; i < nodes * BOX_WIDTH; i++) {
            box b = nothing;
            if (i < below && level == 0) b = items[tree->item[i]];
            if (i < below && level > 0) b = union_of_children(&tree->node[tree->first[level - 1] + i]);
            set_child(&tree->node[tree->first[level] + i / BOX_WIDTH], i % BOX_WIDTH, &b);
        }
        below = nodes;
    }
}

jali_status box_tree_create(jali_context *ctx, int32_t item_count, const box *items, box_tree *tree)
{
    jali_status status = JALI_OK;
    uint64_t *code = NULL;
    int32_t *spare = NULL;
    *tree = (box_tree){.item_count = item_count};
    if (item_count == 0) return JALI_OK;
    int32_t nodes = item_count;
    do {
        nodes = (nodes - 1) / BOX_WIDTH + 1;
        tree->first[tree->level_count + 1] = tree->first[tree->level_count] + nodes;
        tree->level_count++;
    } while (nodes > 1);
    TRY(ALLOCATE(ctx, tree->item, item_count));
    TRY(ALLOCATE(ctx, tree->node, tree->first[tree->level_count]));
    TRY(ALLOCATE(ctx, code, item_count));
    TRY(ALLOCATE(ctx, spare, item_count));
    morton_codes(item_count, items, code);
    sort_by_code(item_count, code, tree->item, spare);
    fill_levels(tree, items);
done:
    release(ctx, spare);
    release(ctx, code);
    if (status != JALI_OK) box_tree_free(ctx, tree);
    return status;
}

void box_tree_free(jali_context *ctx, box_tree *tree)
{
    release(ctx, tree->node);
    release(ctx, tree->item);
    *tree = (box_tree){0};
}
