// Mending a mesh.
//
// Weld equal places, drop triangles without area and second copies; walk over edges of two triangles and turn
// over what disagrees with its neighbour; turn whole parts outwards: an open one by its volume as seen from
// the middle of its rim, a closed one by how many others enclose it. Nothing is invented: holes stay open,
// crowded edges crowded. A shell that crosses another is neither within it nor its void.
//
// Limits:  a triangle on a line with three places of its own leaves a crack when it is dropped. A body within
//          a body is taken for a void, a void that crosses a body for a body.
// Checked: tests/test_mend.c: cubes with each flaw, shells in shells, real files.
#include "mesh/mend.h"

#include "mesh/nesting.h"

#include <math.h>

typedef struct mending {
    jali_context *ctx;
    jali_mesh *mesh;
    double (*uv)[3][2];
    bool *marked;
    jali_surface_report *report;
    topology_marks marks;
    bool *turned;          // [triangle_count], turned over against the file
    int32_t *part, *queue; // [triangle_count]: parts connected through edges of two triangles
    int32_t part_count;
} mending;

static void centre_of(const jali_mesh *mesh, int32_t t, double at_mm[3])
{
    const int32_t *v = mesh->triangle[t];
    for (int k = 0; k < 3; k++)
        at_mm[k] = (mesh->vertex[v[0]][k] + mesh->vertex[v[1]][k] + mesh->vertex[v[2]][k]) / 3;
}

static void middle_of(const jali_mesh *mesh, int32_t a, int32_t b, double at_mm[3])
{
    for (int k = 0; k < 3; k++) at_mm[k] = 0.5 * (mesh->vertex[a][k] + mesh->vertex[b][k]);
}

static void note_triangle(const jali_mesh *mesh, int32_t t, jali_finding *f)
{
    if (f->count++ == 0) centre_of(mesh, t, f->at_mm);
}

// ---- dropping ----

// Places are multiples of one unit below 2^24 of it, so every product is exact in a double.
static bool has_area(const jali_mesh *mesh, const int32_t t[3])
{
    const double *a = mesh->vertex[t[0]], *b = mesh->vertex[t[1]], *c = mesh->vertex[t[2]];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        if ((b[i] - a[i]) * (c[j] - a[j]) != (b[j] - a[j]) * (c[i] - a[i])) return true;
    }
    return false;
}

static jali_status weld_mesh(mending *m)
{
    jali_status status;
    jali_mesh *mesh = m->mesh;
    int32_t *first = NULL, places;
    TRY(ALLOCATE(m->ctx, first, mesh->vertex_count));
    TRY(weld_points(m->ctx, mesh->vertex_count, (const double(*)[3])mesh->vertex, first, &places));
    m->report->welded_vertices = mesh->vertex_count - places;
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) mesh->triangle[t][k] = first[mesh->triangle[t][k]];
done:
    release(m->ctx, first);
    return status;
}

static void sort_three(const int32_t t[3], int32_t sorted[3])
{
    sorted[0] = MIN(t[0], MIN(t[1], t[2]));
    sorted[2] = MAX(t[0], MAX(t[1], t[2]));
    sorted[1] = (int32_t)((int64_t)t[0] + t[1] + t[2] - sorted[0] - sorted[2]);
}

// Has the triangle, either way round, been put in the table before? If not, it is now.
static bool seen_before(const jali_mesh *mesh, int32_t *table, size_t slots, int32_t t)
{
    int32_t wanted[3], there[3];
    sort_three(mesh->triangle[t], wanted);
    uint64_t hash = 0;
    for (int k = 0; k < 3; k++) hash = (hash ^ (uint32_t)wanted[k]) * UINT64_C(0x9e3779b97f4a7c15);
    for (size_t slot = (hash ^ hash >> 32) & (slots - 1);; slot = (slot + 1) & (slots - 1)) {
        if (!table[slot]) {
            table[slot] = t + 1;
            return false;
        }
        sort_three(mesh->triangle[table[slot] - 1], there);
        if (memcmp(wanted, there, sizeof wanted) == 0) return true;
    }
}

static jali_status drop_triangles(mending *m)
{
    jali_mesh *mesh = m->mesh;
    int32_t kept = 0, *table;
    size_t slots = 16;
    while (slots < 2 * (size_t)mesh->triangle_count) slots *= 2;
    jali_status status = ALLOCATE_CLEARED(m->ctx, table, slots);
    if (status != JALI_OK) return status;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        if (!has_area(mesh, mesh->triangle[t])) {
            note_triangle(mesh, t, &m->report->degenerate_triangles);
            continue;
        }
        // The triangle moves first: the table numbers those that are kept.
        memmove(mesh->triangle[kept], mesh->triangle[t], sizeof *mesh->triangle);
        if (m->uv) memmove(m->uv[kept], m->uv[t], sizeof *m->uv);
        if (m->marked) m->marked[kept] = m->marked[t];
        if (seen_before(mesh, table, slots, kept))
            note_triangle(mesh, kept, &m->report->repeated_triangles);
        else
            kept++;
    }
    mesh->triangle_count = kept;
    release(m->ctx, table);
    return JALI_OK;
}

// Vertices that no triangle names go.
static jali_status number_vertices(mending *m)
{
    jali_mesh *mesh = m->mesh;
    int32_t *number, next = 0;
    jali_status status = ALLOCATE_CLEARED(m->ctx, number, mesh->vertex_count);
    if (status != JALI_OK) return status;
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) number[mesh->triangle[t][k]] = 1;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        if (!number[v]) continue;
        number[v] = next;
        memmove(mesh->vertex[next++], mesh->vertex[v], sizeof *mesh->vertex);
    }
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) mesh->triangle[t][k] = number[mesh->triangle[t][k]];
    mesh->vertex_count = next;
    release(m->ctx, number);
    return JALI_OK;
}

// ---- turning ----

// Do two triangles run their common edge in opposite directions, as the file has them?
static bool agrees(const jali_mesh *mesh, int32_t side, int32_t twin)
{
    return mesh->triangle[side / 3][side % 3] == mesh->triangle[twin / 3][(twin + 1) % 3];
}

// From the first triangle of each part outwards; the first side that reaches a triangle decides for it.
static void turn_towards_neighbours(mending *m)
{
    const jali_mesh *mesh = m->mesh;
    for (int32_t t = 0; t < mesh->triangle_count; t++) m->part[t] = -1;
    for (int32_t seed = 0; seed < mesh->triangle_count; seed++) {
        if (m->part[seed] >= 0) continue;
        int32_t count = 0;
        m->part[seed] = m->part_count;
        m->queue[count++] = seed;
        for (int32_t next = 0; next < count; next++)
            for (int k = 0; k < 3; k++) {
                int32_t side = 3 * m->queue[next] + k, twin = m->marks.twin[side];
                if (twin < 0 || m->part[twin / 3] >= 0) continue;
                m->part[twin / 3] = m->part_count;
                m->turned[twin / 3] = m->turned[side / 3] ^ !agrees(mesh, side, twin);
                m->queue[count++] = twin / 3;
            }
        m->part_count++;
    }
}

typedef struct part_measure {
    double middle[3], volume, area; // the middle of its open and crowded edges
    int64_t rim_sides;
} part_measure;

static void add_volume(const mending *m, int32_t t, part_measure *part)
{
    double p[3][3], n[3];
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) p[c][k] = m->mesh->vertex[m->mesh->triangle[t][c]][k] - part->middle[k];
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] = (p[1][i] - p[0][i]) * (p[2][j] - p[0][j]) - (p[1][j] - p[0][j]) * (p[2][i] - p[0][i]);
    }
    double volume = (n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2]) / 6;
    part->volume += m->turned[t] ? -volume : volume;
    part->area += 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

// A part whose volume, seen from the middle of its rim, is negative faces inwards. A flat one stays as it is.
static jali_status turn_parts_outwards(mending *m)
{
    static const double flat = 1e-6; // of area^(3/2): a sheet, its rounding at most
    const jali_mesh *mesh = m->mesh;
    part_measure *part;
    jali_status status = ALLOCATE_CLEARED(m->ctx, part, m->part_count);
    if (status != JALI_OK) return status;
    for (int32_t side = 0; side < 3 * mesh->triangle_count; side++) {
        if (m->marks.twin[side] >= 0) continue;
        part_measure *p = &part[m->part[side / 3]];
        p->rim_sides++;
        for (int k = 0; k < 3; k++) p->middle[k] += mesh->vertex[mesh->triangle[side / 3][side % 3]][k];
    }
    for (int32_t i = 0; i < m->part_count; i++)
        for (int k = 0; k < 3; k++) part[i].middle[k] /= (double)MAX(part[i].rim_sides, 1);
    for (int32_t t = 0; t < mesh->triangle_count; t++) add_volume(m, t, &part[m->part[t]]);
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const part_measure *p = &part[m->part[t]];
        m->turned[t] ^= p->volume < -flat * p->area * sqrt(p->area);
    }
    release(m->ctx, part);
    return JALI_OK;
}

static void turn_over(mending *m, int32_t t)
{
    int32_t *v = m->mesh->triangle[t], swap = v[1];
    v[1] = v[2];
    v[2] = swap;
    if (!m->uv) return;
    double corner[2];
    memcpy(corner, m->uv[t][1], sizeof corner);
    memcpy(m->uv[t][1], m->uv[t][2], sizeof corner);
    memcpy(m->uv[t][2], corner, sizeof corner);
}

// A shell that crosses another one is not within it, wherever its first vertex lies.
static void find_crossing_shells(const exact_surface *s, const topology *t, const bool *met, bool *crossing)
{
    for (int32_t place = 0; place < s->face_count; place++) {
        int32_t a = s->face[s->tree.item[place]];
        if (!met[a]) continue;
        box b = box_of_triangle(s->l, s->triangle[a]);
        box_walk walk = box_walk_start(&s->tree, &b, place + 1);
        for (int32_t other; (other = box_walk_next(&walk)) >= 0;) {
            int32_t c = s->face[s->tree.item[other]];
            if (!met[c] || t->shell[a] == t->shell[c] || t->shell[a] < 0 || t->shell[c] < 0) continue;
            if (crossing[t->shell[a]] && crossing[t->shell[c]]) continue;
            if (triangles_meet(s->l, s->triangle[a], s->triangle[c]))
                crossing[t->shell[a]] = crossing[t->shell[c]] = true;
        }
    }
}

// All closed shells face outwards; one within an odd number of others is a void and faces inwards.
static void turn_voids(mending *m, const topology *t, const int32_t *winding, const bool *crossing)
{
    for (int32_t i = 0; i < m->mesh->triangle_count; i++) {
        int32_t shell = t->shell[i];
        if (shell < 0 || t->flawed[shell] || crossing[shell] || winding[shell] % 2 == 0) continue;
        turn_over(m, i);
        m->turned[i] ^= true;
    }
}

// ---- what is left ----

static jali_finding finding_of(const jali_mesh *mesh, const finding *f)
{
    jali_finding result = {.count = f->count};
    if (f->count) middle_of(mesh, f->a, f->b, result.at_mm);
    return result;
}

static void mark_faults(const mending *m)
{
    const jali_mesh *mesh = m->mesh;
    bool *faulty = m->report->faulty;
    for (int32_t side = 0; side < 3 * mesh->triangle_count; side++) {
        int32_t twin = m->marks.twin[side];
        bool bad = twin == TWIN_CROWDED || (twin >= 0 && !agrees(mesh, side, twin));
        faulty[side / 3] |=
            bad || (m->marked && m->marked[side / 3]) || m->marks.crowded[mesh->triangle[side / 3][side % 3]];
    }
}

static jali_status find_faults(mending *m, const topology *t)
{
    jali_status status;
    jali_mesh *mesh = m->mesh;
    jali_surface_report *report = m->report;
    const int32_t(*triangle)[3] = (const int32_t(*)[3])mesh->triangle;
    lattice l = {0};
    exact_surface s = {0};
    int32_t *winding = NULL;
    bool *met = NULL, *crossing = NULL;
    finding crossings;
    mark_faults(m); // before whole shells are turned, which renumbers sides
    TRY(lattice_create(m->ctx, mesh->vertex_count, (const double(*)[3])mesh->vertex, &l));
    TRY(exact_surface_create(m->ctx, &l, mesh->triangle_count, triangle, &s));
    TRY(ALLOCATE(m->ctx, winding, t->shell_count));
    TRY(ALLOCATE_CLEARED(m->ctx, crossing, t->shell_count));
    TRY(ALLOCATE_CLEARED(m->ctx, met, mesh->triangle_count));
    TRY(count_intersections(m->ctx, &s, met, &crossings, &report->intersections_capped));
    for (int32_t i = 0; i < mesh->triangle_count; i++) report->faulty[i] |= met[i];
    if (crossings.count && t->shell_count > 1) find_crossing_shells(&s, t, met, crossing);
    shell_windings(&s, t, winding);
    turn_voids(m, t, winding, crossing);
    report->shells = t->shell_count;
    report->open_edges = finding_of(mesh, &t->open_edges);
    report->crowded_edges = finding_of(mesh, &t->crowded_edges);
    report->crowded_vertices = finding_of(mesh, &t->crowded_vertices);
    report->misdirected_edges = finding_of(mesh, &t->misdirected_edges);
    report->intersections.count = crossings.count;
    if (crossings.count) centre_of(mesh, crossings.a, report->intersections.at_mm);
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        if (m->turned[i]) note_triangle(mesh, i, &report->turned_triangles);
        report->faulty_triangles += report->faulty[i];
    }
done:
    release(m->ctx, winding);
    release(m->ctx, met);
    release(m->ctx, crossing);
    exact_surface_free(m->ctx, &s);
    lattice_free(m->ctx, &l);
    return status;
}

jali_status mend(jali_context *ctx, jali_mesh *mesh, double (*uv)[3][2], bool *marked,
                 jali_surface_report *report)
{
    jali_status status;
    mending m = {.ctx = ctx, .mesh = mesh, .uv = uv, .marked = marked, .report = report};
    topology t = {0};
    TRY(weld_mesh(&m));
    TRY(drop_triangles(&m));
    TRY(number_vertices(&m));
    TRY(ALLOCATE_CLEARED(ctx, report->faulty, mesh->triangle_count));
    TRY(ALLOCATE_CLEARED(ctx, m.turned, mesh->triangle_count));
    TRY(ALLOCATE(ctx, m.part, mesh->triangle_count));
    TRY(ALLOCATE(ctx, m.queue, mesh->triangle_count));
    TRY(ALLOCATE(ctx, m.marks.twin, 3 * (size_t)mesh->triangle_count));
    TRY(ALLOCATE(ctx, m.marks.crowded, mesh->vertex_count));
    TRY(topology_mark(ctx, mesh->vertex_count, mesh->triangle_count, (const int32_t(*)[3])mesh->triangle,
                      &m.marks, &t));
    turn_towards_neighbours(&m);
    TRY(turn_parts_outwards(&m));
    for (int32_t i = 0; i < mesh->triangle_count; i++)
        if (m.turned[i]) turn_over(&m, i);
    // Sides have other numbers in triangles that were turned over.
    topology_free(ctx, &t);
    TRY(topology_mark(ctx, mesh->vertex_count, mesh->triangle_count, (const int32_t(*)[3])mesh->triangle,
                      &m.marks, &t));
    TRY(find_faults(&m, &t));
done:
    topology_free(ctx, &t);
    release(ctx, m.turned);
    release(ctx, m.part);
    release(ctx, m.queue);
    release(ctx, m.marks.twin);
    release(ctx, m.marks.crowded);
    return status;
}
