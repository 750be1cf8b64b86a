// connect: Algorithm 2 bridge by bridge against a plain implementation, and what the octagonal metric
// promises.
#include "testing.h"
#include "plain.h"
#include "raster/raster.h"

#include <jali/connect.h>

#include <math.h>

// --- The oracle: components by flood fill, all pairs of pixels, the tie rules of jali/connect.h

typedef struct greedy {
    plain p;
    int32_t *label; // of the picture as it is now
    int32_t *owner; // component in the drawing; of a bridge's pixel the one it was laid from
    int32_t count;  // components now
    int64_t pixels; // laid
} greedy;

static greedy greedy_begin(const jali_bitmap *drawing)
{
    greedy g = {.p = plain_of(drawing)};
    size_t n = (size_t)g.p.w * (size_t)g.p.h + 1;
    g.label = malloc(n * sizeof *g.label);
    g.owner = malloc(n * sizeof *g.owner);
    g.count = plain_label(&g.p, true, 4, g.label);
    memcpy(g.owner, g.label, n * sizeof *g.owner - sizeof *g.owner);
    return g;
}

static void greedy_end(greedy *g)
{
    plain_free(&g->p);
    free(g->label);
    free(g->owner);
}

// Labels go by first pixel in raster order, so the first of the smallest is the one that the rule names.
static int32_t greedy_smallest(const greedy *g)
{
    int32_t *area = calloc((size_t)g->count, sizeof *area), smallest = 0;
    for (int32_t i = 0; i < g->p.w * g->p.h; i++)
        if (g->label[i] >= 0) area[g->label[i]]++;
    for (int32_t k = 1; k < g->count; k++)
        if (area[k] < area[smallest]) smallest = k;
    free(area);
    return smallest;
}

static int64_t city_block(int32_t w, int32_t i, int32_t j)
{
    return llabs((int64_t)i % w - j % w) + llabs((int64_t)i / w - j / w);
}

static int64_t squared(int32_t w, int32_t i, int32_t j)
{
    int64_t dx = i % w - j % w, dy = i / w - j / w;
    return dx * dx + dy * dy;
}

// The nearest pair of a pixel of the part and one of any other: first target, then first source.
static int64_t greedy_nearest(const greedy *g, int32_t part, int64_t (*distance)(int32_t, int32_t, int32_t),
                              int32_t *from, int32_t *to)
{
    int64_t best = INT64_MAX;
    int32_t n = g->p.w * g->p.h;
    int32_t *own = malloc((size_t)n * sizeof *own), own_count = 0;
    for (int32_t i = 0; i < n; i++)
        if (g->label[i] == part) own[own_count++] = i;
    for (int32_t j = 0; j < n; j++) {
        if (g->label[j] < 0 || g->label[j] == part) continue;
        for (int32_t k = 0; k < own_count; k++) {
            int64_t d = distance(g->p.w, own[k], j);
            if (d >= best) continue;
            best = d;
            *from = own[k];
            *to = j;
        }
    }
    free(own);
    return best;
}

// From pixel to pixel, always to the neighbour nearer to the straight line; of two as near the one above or
// below.
static void greedy_lay(greedy *g, const int32_t from[2], const int32_t to[2], int32_t owner)
{
    int64_t wide = llabs((int64_t)to[0] - from[0]), high = llabs((int64_t)to[1] - from[1]), x = 0, y = 0;
    while (x + y < wide + high - 1) {
        int64_t off_if_x = llabs((x + 1) * high - y * wide), off_if_y = llabs(x * high - (y + 1) * wide);
        if (y == high || (x < wide && off_if_x < off_if_y))
            x++;
        else
            y++;
        int64_t column = from[0] + (to[0] > from[0] ? x : -x), row = from[1] + (to[1] > from[1] ? y : -y);
        int64_t i = row * g->p.w + column;
        if (g->p.white[i]) continue;
        g->p.white[i] = 1;
        g->owner[i] = owner;
        g->pixels++;
    }
    g->count = plain_label(&g->p, true, 4, g->label);
}

// --- The library against it

static int32_t index_of(const greedy *g, const int32_t pixel[2])
{
    return pixel[1] * g->p.w + pixel[0];
}

static void check_city_block(greedy *g, const jali_bridge *bridge)
{
    int32_t from = -1, to = -1;
    greedy_nearest(g, greedy_smallest(g), city_block, &from, &to);
    CHECK_INT(index_of(g, bridge->from), from);
    CHECK_INT(index_of(g, bridge->to), to);
    CHECK_INT(bridge->part[0], g->owner[from]);
    CHECK_INT(bridge->part[1], g->owner[to]);
}

// An octagon's corner is 8.4 % farther from its middle than its side is; steps are whole pixels.
static void check_octagon(greedy *g, const jali_bridge *bridge)
{
    int32_t from = -1, to = -1, smallest = greedy_smallest(g);
    double nearest = sqrt((double)greedy_nearest(g, smallest, squared, &from, &to));
    double length = sqrt((double)squared(g->p.w, index_of(g, bridge->from), index_of(g, bridge->to)));
    CHECK_INT(g->label[index_of(g, bridge->from)], smallest);
    CHECK(g->label[index_of(g, bridge->to)] >= 0 && g->label[index_of(g, bridge->to)] != smallest);
    CHECK(length <= 1.084 * nearest + 1);
    CHECK_INT(bridge->part[0], g->owner[index_of(g, bridge->from)]);
    CHECK_INT(bridge->part[1], g->owner[index_of(g, bridge->to)]);
}

static void check_connect(const jali_bitmap *drawing, jali_metric metric)
{
    jali_connect_options opt = {.metric = metric};
    jali_bitmap joined;
    jali_bridges bridges;
    CHECK_OK(jali_connect(ctx, drawing, &opt, &joined, &bridges));
    greedy g = greedy_begin(drawing);
    for (int32_t i = 0; i < bridges.count; i++) {
        CHECK(g.count > 1);
        if (metric == JALI_METRIC_CITY_BLOCK)
            check_city_block(&g, &bridges.bridge[i]);
        else
            check_octagon(&g, &bridges.bridge[i]);
        greedy_lay(&g, bridges.bridge[i].from, bridges.bridge[i].to, bridges.bridge[i].part[0]);
    }
    CHECK(g.count <= 1);
    CHECK(plain_equals(&g.p, &joined));
    CHECK_INT(bridges.pixels, g.pixels);
    greedy_end(&g);
    jali_bitmap_free(ctx, &joined);
    jali_bridges_free(ctx, &bridges);
}

static void check_random(int32_t pictures, int32_t most_wide, int32_t most_high, int32_t percent,
                         uint64_t seed)
{
    for (int32_t i = 0; i < pictures; i++) {
        int32_t w = 1 + (int32_t)(next_random(&seed) >> 40) % most_wide,
                h = 1 + (int32_t)(next_random(&seed) >> 40) % most_high;
        jali_bitmap a = random_bitmap(&seed, w, h, 1 + (int32_t)(next_random(&seed) >> 40) % percent);
        check_connect(&a, JALI_METRIC_CITY_BLOCK);
        check_connect(&a, JALI_METRIC_OCTAGON);
        jali_bitmap_free(ctx, &a);
    }
}

TEST(every_bridge_is_the_greedy_one_on_small_pictures)
{
    check_random(3000, 12, 12, 90, 1);
}

TEST(every_bridge_is_the_greedy_one_across_words)
{
    check_random(300, 140, 8, 80, 2);
    check_random(60, 30, 70, 40, 3);
}

TEST(every_bridge_is_the_greedy_one_far_apart)
{
    uint64_t seed = 4;
    for (int32_t i = 0; i < 60; i++) {
        int32_t w = 100 + (int32_t)(next_random(&seed) >> 40) % 400,
                h = 1 + (int32_t)(next_random(&seed) >> 40) % 90;
        jali_bitmap a;
        CHECK_OK(jali_bitmap_create(ctx, w, h, &a));
        for (int32_t k = 0; k < 2 + i % 5; k++)
            jali_bitmap_set(&a, (int32_t)(next_random(&seed) >> 40) % w,
                            (int32_t)(next_random(&seed) >> 40) % h, true);
        check_connect(&a, JALI_METRIC_CITY_BLOCK);
        check_connect(&a, JALI_METRIC_OCTAGON);
        jali_bitmap_free(ctx, &a);
    }
}

// Few dots in a wide void: steps are taken many at once, and taken back where they go too far.
TEST(every_bridge_is_the_greedy_one_in_a_wide_void)
{
    uint64_t seed = 12;
    for (int32_t i = 0; i < 400; i++) {
        jali_bitmap a;
        CHECK_OK(jali_bitmap_create(ctx, 150, 90, &a));
        for (int32_t k = 0; k < 3 + i % 12; k++) {
            int32_t x = (int32_t)(next_random(&seed) >> 40) % 148,
                    y = (int32_t)(next_random(&seed) >> 40) % 88;
            for (int32_t dx = 0; dx < 1 + k % 3; dx++) jali_bitmap_set(&a, x + dx, y + dx / 2, true);
        }
        check_connect(&a, JALI_METRIC_CITY_BLOCK);
        check_connect(&a, JALI_METRIC_OCTAGON);
        jali_bitmap_free(ctx, &a);
    }
}

// Frames within frames, each a part as large as what it holds, and dots between them.
static jali_bitmap random_frames(uint64_t *seed, int32_t width, int32_t height)
{
    jali_bitmap a;
    CHECK_OK(jali_bitmap_create(ctx, width, height, &a));
    for (int32_t x0 = 0, y0 = 0, x1 = width, y1 = height; x1 - x0 > 8 && y1 - y0 > 8;) {
        int32_t in[4], thick = 1 + (int32_t)(next_random(seed) >> 40) % 3;
        for (int32_t k = 0; k < 4; k++) in[k] = 1 + (int32_t)(next_random(seed) >> 40) % 70;
        x0 += in[0], y0 += in[1], x1 -= in[2], y1 -= in[3];
        for (int32_t y = y0; y < y1; y++)
            for (int32_t x = x0; x < x1; x++)
                if (MIN(MIN(x - x0, x1 - 1 - x), MIN(y - y0, y1 - 1 - y)) < thick)
                    jali_bitmap_set(&a, x, y, true);
        x0 += thick, y0 += thick, x1 -= thick, y1 -= thick;
        if (x1 - x0 > 8 && y1 - y0 > 8)
            jali_bitmap_set(&a, x0 + (int32_t)(next_random(seed) >> 40) % (x1 - x0),
                            y0 + (int32_t)(next_random(seed) >> 40) % (y1 - y0), true);
    }
    return a;
}

TEST(every_bridge_is_the_greedy_one_around_large_parts)
{
    uint64_t seed = 13;
    for (int32_t i = 0; i < 8; i++) {
        jali_bitmap a = random_frames(&seed, 420, 400);
        check_connect(&a, JALI_METRIC_CITY_BLOCK);
        check_connect(&a, JALI_METRIC_OCTAGON);
        jali_bitmap_free(ctx, &a);
    }
}

TEST(all_pictures_of_4x4)
{
    jali_bitmap a;
    CHECK_OK(jali_bitmap_create(ctx, 4, 4, &a));
    for (uint32_t bits = 0; bits < 1 << 16; bits += 7) {
        for (int32_t i = 0; i < 16; i++) jali_bitmap_set(&a, i % 4, i / 4, bits >> i & 1);
        check_connect(&a, JALI_METRIC_CITY_BLOCK);
    }
    jali_bitmap_free(ctx, &a);
}

static int32_t bridges_of(const char *picture, int32_t width)
{
    jali_bitmap a = drawn_rows(width, picture), joined;
    jali_bridges bridges;
    check_connect(&a, JALI_METRIC_CITY_BLOCK);
    check_connect(&a, JALI_METRIC_OCTAGON);
    CHECK_OK(jali_connect(ctx, &a, NULL, &joined, &bridges));
    int32_t count = bridges.count;
    if (count == 0) CHECK(same_bitmap(&a, &joined));
    jali_bridges_free(ctx, &bridges);
    jali_bitmap_free(ctx, &joined);
    jali_bitmap_free(ctx, &a);
    return count;
}

TEST(nothing_to_join_changes_nothing)
{
    CHECK_INT(bridges_of("....", 2), 0); // no component at all
    CHECK_INT(bridges_of("...#.....", 3), 0);
    CHECK_INT(bridges_of("#", 1), 0);
    CHECK_INT(bridges_of(".", 1), 0);
    CHECK_INT(bridges_of("####"
                         "#..#"
                         "####",
                         4),
              0);
}

TEST(touching_corners_are_two_parts)
{
    CHECK_INT(bridges_of("#."
                         ".#",
                         2),
              1);
    CHECK_INT(bridges_of("#.#"
                         ".#."
                         "#.#",
                         3),
              3); // the first bridge touches three parts at once
}

TEST(a_bridge_shortens_later_ones)
{
    // The bridge between the two small parts passes above the large one, which is nearer to it than to them.
    jali_bitmap joined, a = drawn_rows(13, "#...........#"
                                           "#...........#"
                                           "............#"
                                           "............."
                                           "............."
                                           "............."
                                           "............."
                                           "............."
                                           "............."
                                           "....#####...."
                                           "....#####...."
                                           "....#####...."
                                           "....#####....");
    jali_bridges bridges;
    check_connect(&a, JALI_METRIC_CITY_BLOCK);
    CHECK_OK(jali_connect(ctx, &a, NULL, &joined, &bridges));
    CHECK_INT(bridges.count, 2);
    CHECK_INT(bridges.pixels, 11 + 8);
    const jali_bridge *second = &bridges.bridge[1];
    CHECK(second->from[0] == 4 && second->from[1] == 0 && second->to[0] == 4 && second->to[1] == 9);
    CHECK(second->part[0] == 0 && second->part[1] == 2); // the first bridge was laid from part 0
    jali_bridges_free(ctx, &bridges);
    jali_bitmap_free(ctx, &joined);
    jali_bitmap_free(ctx, &a);
}

TEST(the_picture_may_be_its_own_result)
{
    uint64_t seed = 6;
    jali_bitmap a = random_bitmap(&seed, 80, 30, 30), joined;
    CHECK_OK(jali_connect(ctx, &a, NULL, &joined, NULL));
    CHECK_OK(jali_connect(ctx, &a, NULL, &a, NULL));
    CHECK(same_bitmap(&a, &joined));
    jali_bitmap_free(ctx, &a);
    jali_bitmap_free(ctx, &joined);
}

// With several threads parts are searched for before their turn: near ones, far ones, in crowds and alone.
static void check_threads(jali_context *by_threads[3], const jali_bitmap *a, jali_metric metric)
{
    jali_connect_options opt = {.metric = metric};
    jali_bitmap joined[3];
    jali_bridges bridges[3];
    for (int32_t i = 0; i < 3; i++) {
        CHECK_INT(jali_connect(by_threads[i], a, &opt, &joined[i], &bridges[i]), JALI_OK);
        CHECK(same_bitmap(&joined[i], &joined[0]));
        CHECK_INT(bridges[i].count, bridges[0].count);
        CHECK(memcmp(bridges[i].bridge, bridges[0].bridge, (size_t)bridges[0].count * sizeof(jali_bridge)) ==
              0);
    }
    for (int32_t i = 0; i < 3; i++) {
        jali_bitmap_free(by_threads[i], &joined[i]);
        jali_bridges_free(by_threads[i], &bridges[i]);
    }
}

TEST(any_number_of_threads_gives_the_same_bytes)
{
    static const struct {
        int32_t width, height, most; // white pixels in a thousand
    } pictures[] = {{300, 200, 100}, {300, 200, 300}, {300, 200, 500}, {900, 700, 2}, {4000, 60, 3}};
    uint64_t seed = 8;
    jali_context *by_threads[3];
    open_thread_contexts(by_threads);
    for (size_t i = 0; i < sizeof pictures / sizeof *pictures; i++) {
        jali_bitmap a;
        CHECK_OK(jali_bitmap_create(ctx, pictures[i].width, pictures[i].height, &a));
        for (int64_t k = (int64_t)a.width_px * a.height_px * pictures[i].most / 1000; k > 0; k--)
            jali_bitmap_set(&a, (int32_t)((next_random(&seed) >> 40) % (uint64_t)a.width_px),
                            (int32_t)((next_random(&seed) >> 40) % (uint64_t)a.height_px), true);
        check_threads(by_threads, &a, JALI_METRIC_CITY_BLOCK);
        check_threads(by_threads, &a, JALI_METRIC_OCTAGON);
        jali_bitmap_free(ctx, &a);
    }
    for (int32_t i = 0; i < 12; i++) {
        jali_bitmap a = random_frames(&seed, 500 + 60 * i, 900 - 40 * i);
        check_threads(by_threads, &a, JALI_METRIC_CITY_BLOCK);
        check_threads(by_threads, &a, JALI_METRIC_OCTAGON);
        jali_bitmap_free(ctx, &a);
    }
    close_thread_contexts(by_threads);
}

static jali_status connect_some(jali_context *limited, void *data)
{
    jali_bitmap joined;
    jali_bridges bridges;
    jali_status status = jali_connect(limited, data, NULL, &joined, &bridges);
    if (status != JALI_OK) CHECK(joined.word == NULL && bridges.bridge == NULL && bridges.count == 0);
    jali_bitmap_free(limited, &joined);
    jali_bridges_free(limited, &bridges);
    return status;
}

TEST(every_allocation_refused_once)
{
    uint64_t seed = 7;
    jali_bitmap a = random_bitmap(&seed, 90, 60, 3); // sparse, so that the search widens its window
    refuse_each_allocation(connect_some, &a);
    jali_bitmap_free(ctx, &a);
}

TEST(a_cancelled_run_has_no_result)
{
    uint64_t seed = 7;
    jali_bitmap joined, a = random_bitmap(&seed, 90, 60, 30);
    jali_context *other;
    CHECK_INT(jali_context_create(NULL, &other), JALI_OK);
    jali_cancel(other);
    CHECK_INT(jali_connect(other, &a, NULL, &joined, NULL), JALI_CANCELLED);
    CHECK(joined.word == NULL && strlen(jali_message(other)) > 0);
    jali_context_free(other);
    jali_bitmap_free(ctx, &a);
}

// --- Around what is blocked

// Steps along rows and columns from a part to any other through black pixels that are not blocked; -1: none.
static int32_t steps_around(const greedy *g, const plain *blocked, int32_t part)
{
    int32_t n = g->p.w * g->p.h, head = 0, tail = 0, found = -1;
    int32_t *queue = malloc((size_t)n * sizeof *queue), *far = malloc((size_t)n * sizeof *far);
    for (int32_t i = 0; i < n; i++) {
        far[i] = g->label[i] == part ? 0 : -1;
        if (far[i] == 0) queue[tail++] = i;
    }
    while (head < tail && found < 0) {
        int32_t i = queue[head++], x = i % g->p.w, y = i / g->p.w;
        const int32_t beside[4][2] = {{x, y - 1}, {x - 1, y}, {x + 1, y}, {x, y + 1}};
        for (int32_t k = 0; k < 4 && found < 0; k++) {
            int32_t j = beside[k][1] * g->p.w + beside[k][0];
            if (!plain_inside(&g->p, beside[k][0], beside[k][1]) || far[j] >= 0) continue;
            if (blocked->white[j] && !g->p.white[j]) continue;
            far[j] = far[i] + 1;
            queue[tail++] = j;
            if (g->p.white[j]) found = far[j];
        }
    }
    free(queue);
    free(far);
    return found;
}

static int32_t length_of(const jali_bridges *bridges, int32_t i)
{
    int32_t from[2], to[2], length = 0;
    for (int32_t leg = 0; jali_bridge_leg(bridges, i, leg, from, to); leg++)
        length += abs(to[0] - from[0]) + abs(to[1] - from[1]);
    return length;
}

// No blocked pixel is laid, what can be joined is, the first bridge is a shortest one.
static void check_around(const jali_bitmap *drawing, const jali_bitmap *blocked, jali_metric metric)
{
    jali_connect_options opt = {.metric = metric, .blocked = blocked};
    jali_bitmap joined;
    jali_bridges bridges;
    CHECK_OK(jali_connect(ctx, drawing, &opt, &joined, &bridges));
    greedy g = greedy_begin(drawing);
    plain walls = plain_of(blocked), reached = plain_of(drawing), after = plain_of(&joined);
    int32_t n = walls.w * walls.h, *label = malloc(((size_t)n + 1) * sizeof *label);
    for (int32_t i = 0; i < n; i++) {
        CHECK(after.white[i] >= reached.white[i]);
        CHECK(!walls.white[i] || after.white[i] == reached.white[i]);
        reached.white[i] |= !walls.white[i];
    }
    CHECK_INT(plain_label(&after, true, 4, label), g.count ? 1 + bridges.stranded : 0);
    plain_label(&reached, true, 4, label); // rooms: no two parts of one are apart
    int32_t rooms = 0;
    for (int32_t i = 0; i < n; i++) {
        if (g.label[i] < 0) continue;
        bool first = true;
        for (int32_t k = 0; k < i && first; k++) first = g.label[k] < 0 || label[k] != label[i];
        rooms += first;
    }
    CHECK_INT(rooms, g.count ? 1 + bridges.stranded : 0);
    int32_t steps = g.count > 1 ? steps_around(&g, &walls, greedy_smallest(&g)) : -1;
    if (steps >= 0 && metric == JALI_METRIC_CITY_BLOCK) CHECK_INT(length_of(&bridges, 0), steps);
    free(label);
    plain_free(&walls);
    plain_free(&reached);
    plain_free(&after);
    greedy_end(&g);
    jali_bitmap_free(ctx, &joined);
    jali_bridges_free(ctx, &bridges);
}

TEST(bridges_bend_around_what_is_blocked)
{
    uint64_t seed = 21;
    for (int32_t i = 0; i < 1500; i++) {
        int32_t w = 1 + (int32_t)(next_random(&seed) >> 40) % 40,
                h = 1 + (int32_t)(next_random(&seed) >> 40) % 24;
        jali_bitmap a = random_bitmap(&seed, w, h, 1 + (int32_t)(next_random(&seed) >> 40) % 30),
                    walls = i % 2 ? random_bitmap(&seed, w, h, 1 + (int32_t)(next_random(&seed) >> 40) % 60)
                                  : random_blobs(&seed, w, h, 4, 30);
        check_around(&a, &walls, JALI_METRIC_CITY_BLOCK);
        check_around(&a, &walls, JALI_METRIC_OCTAGON);
        jali_bitmap_free(ctx, &a);
        jali_bitmap_free(ctx, &walls);
    }
}

// Farther than the first window.
TEST(a_long_way_round_is_found_and_a_room_without_a_door_is_not)
{
    jali_bitmap a, walls;
    jali_connect_options opt = {.metric = JALI_METRIC_OCTAGON, .blocked = &walls};
    jali_bridges bridges;
    CHECK_OK(jali_bitmap_create(ctx, 700, 300, &a));
    CHECK_OK(jali_bitmap_create(ctx, 700, 300, &walls));
    jali_bitmap_set(&a, 10, 10, true);
    jali_bitmap_set(&a, 30, 10, true);
    for (int32_t y = 0; y < 290; y++) jali_bitmap_set(&walls, 20, y, true);
    jali_bitmap joined;
    CHECK_OK(jali_connect(ctx, &a, &opt, &joined, &bridges));
    CHECK_INT(bridges.count, 1);
    CHECK_INT(bridges.stranded, 0);
    CHECK_INT(bridges.bridge[0].via_count, 2); // around the end of the wall: one corner on each side
    CHECK_INT(bridges.via[0][1], 290);
    CHECK_INT(bridges.via[1][1], 290);
    jali_bitmap_free(ctx, &joined);
    jali_bridges_free(ctx, &bridges);
    for (int32_t y = 290; y < 300; y++) jali_bitmap_set(&walls, 20, y, true);
    CHECK_OK(jali_connect(ctx, &a, &opt, &joined, &bridges));
    CHECK_INT(bridges.count, 0);
    CHECK_INT(bridges.stranded, 1);
    CHECK(same_bitmap(&joined, &a));
    jali_bitmap_free(ctx, &joined);
    jali_bridges_free(ctx, &bridges);
    jali_bitmap_free(ctx, &a);
    jali_bitmap_free(ctx, &walls);
}

typedef struct walled {
    jali_bitmap drawing, walls;
} walled;

static jali_status connect_around(jali_context *limited, void *data)
{
    const walled *w = data;
    jali_bitmap joined;
    jali_bridges bridges;
    jali_connect_options opt = {.metric = JALI_METRIC_OCTAGON, .blocked = &w->walls};
    jali_status status = jali_connect(limited, &w->drawing, &opt, &joined, &bridges);
    if (status != JALI_OK) CHECK(joined.word == NULL && bridges.bridge == NULL && bridges.via == NULL);
    jali_bitmap_free(limited, &joined);
    jali_bridges_free(limited, &bridges);
    return status;
}

TEST(every_allocation_refused_once_around_walls)
{
    uint64_t seed = 9;
    walled w = {random_bitmap(&seed, 90, 60, 2), random_blobs(&seed, 90, 60, 5, 40)};
    refuse_each_allocation(connect_around, &w);
    jali_bitmap_free(ctx, &w.drawing);
    jali_bitmap_free(ctx, &w.walls);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bridges_bend_around_what_is_blocked),
        cmocka_unit_test(a_long_way_round_is_found_and_a_room_without_a_door_is_not),
        cmocka_unit_test(every_allocation_refused_once_around_walls),
        cmocka_unit_test(every_bridge_is_the_greedy_one_on_small_pictures),
        cmocka_unit_test(every_bridge_is_the_greedy_one_across_words),
        cmocka_unit_test(every_bridge_is_the_greedy_one_far_apart),
        cmocka_unit_test(every_bridge_is_the_greedy_one_in_a_wide_void),
        cmocka_unit_test(every_bridge_is_the_greedy_one_around_large_parts),
        cmocka_unit_test(all_pictures_of_4x4),
        cmocka_unit_test(nothing_to_join_changes_nothing),
        cmocka_unit_test(touching_corners_are_two_parts),
        cmocka_unit_test(a_bridge_shortens_later_ones),
        cmocka_unit_test(the_picture_may_be_its_own_result),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bytes),
        cmocka_unit_test(every_allocation_refused_once),
        cmocka_unit_test(a_cancelled_run_has_no_result),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
