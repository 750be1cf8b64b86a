// Nested dissection of a mesh that lies in the plane.
//
// Source:  A. George, Nested dissection of a regular finite element mesh, 1973, with the separators found by
//          halving the places along the longer side of their box.
// Checked: tests/test_sparse.c.
#include "sparse/sparse.h"

enum { SMALL = 12, DEEPEST = 64 };

typedef struct keyed {
    double key;
    int32_t row;
} keyed;

// Put the `middle` smallest first (Hoare's selection); rows break ties, so that the outcome is one.
static bool before(const keyed *a, const keyed *b)
{
    return a->key < b->key || (a->key == b->key && a->row < b->row);
}

static void halve(keyed *item, int32_t count, int32_t middle)
{
    int32_t low = 0, high = count - 1;
    while (low < high) {
        keyed pivot = item[low + (high - low) / 2];
        int32_t i = low, j = high;
        while (i <= j) {
            while (before(&item[i], &pivot)) i++;
            while (before(&pivot, &item[j])) j--;
            if (i > j) break;
            keyed other = item[i];
            item[i++] = item[j];
            item[j--] = other;
        }
        if (middle <= j)
            high = j;
        else if (middle >= i)
            low = i;
        else
            return;
    }
}

// Sort the rows into lower half, upper half and, last, those of the lower half that touch the upper one.
static void dissect(const sparse_matrix *a, const double (*place)[2], int32_t *row, int32_t count,
                    keyed *item, uint8_t *upper, int32_t sizes[2])
{
    double low[2] = {place[row[0]][0], place[row[0]][1]}, high[2] = {low[0], low[1]};
    for (int32_t i = 1; i < count; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = MIN(low[k], place[row[i]][k]);
            high[k] = MAX(high[k], place[row[i]][k]);
        }
    int axis = high[1] - low[1] > high[0] - low[0];
    for (int32_t i = 0; i < count; i++) item[i] = (keyed){place[row[i]][axis], row[i]};
    halve(item, count, count / 2);
    for (int32_t i = count / 2; i < count; i++) upper[item[i].row] = 1;
    int32_t inner = 0, outer = count; // the separator fills from the end
    for (int32_t i = 0; i < count / 2; i++) {
        bool joins = false;
        for (int32_t e = a->first[item[i].row]; e < a->first[item[i].row + 1]; e++)
            joins |= upper[a->column[e]] != 0;
        row[joins ? --outer : inner++] = item[i].row;
    }
    sizes[0] = inner;
    sizes[1] = count - count / 2;
    for (int32_t i = count / 2; i < count; i++) {
        upper[item[i].row] = 0;
        row[inner++] = item[i].row;
    }
}

jali_status sparse_order(jali_context *ctx, const sparse_matrix *a, const double (*place)[2], int32_t *order)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    keyed *item;
    uint8_t *upper;
    struct {
        int32_t first, count;
    } todo[2 * DEEPEST]; // each halving leaves one part waiting
    int32_t waiting = 0;
    TRY(ARENA(ctx, item, a->size + 1));
    TRY(ARENA(ctx, upper, a->size + 1));
    memset(upper, 0, (size_t)a->size + 1);
    for (int32_t i = 0; i < a->size; i++) order[i] = i;
    todo[waiting].first = 0;
    todo[waiting++].count = a->size;
    while (waiting > 0) {
        int32_t first = todo[--waiting].first, count = todo[waiting].count, sizes[2];
        if (count <= SMALL) continue;
        dissect(a, place, order + first, count, item, upper, sizes);
        for (int half = 0; half < 2; half++) {
            todo[waiting].first = half ? first + sizes[0] : first;
            todo[waiting++].count = sizes[half];
        }
    }
done:
    arena_rewind(ctx, mark);
    return status;
}
