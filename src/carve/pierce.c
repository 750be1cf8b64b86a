// Pierce a picture through a shell: contours and the edges of the surface in one arrangement on the chart's
// lattice, its solid cells lifted back to the triangles they lie on.
//
// How:     snap rounding makes edges that meet only in lattice points; a constrained triangulation of them
//          has cells that lie each on one triangle of the surface and in one tone. A point on an edge of the
//          surface is lifted along that edge, one inside a triangle by its barycentric coordinates there
//          (perspective ones when the chart is a perspective), on the outer and the inner skin alike: both
//          skins keep their planes.
// Limits:  points and edges move by less than a lattice unit of the chart (1/256 of a working pixel). Where
// two
//          edges of the surface run closer than that, the sliver between them is lost.
// Checked: tests/test_shell.c.
#include <jali/shell.h>

#include "mesh/sides.h"
#include "mesh/slivers.h"
#include "plane/exact.h"
#include "plane/snap.h"
#include "plane/triangulation.h"

#include <math.h>
#include <stdlib.h>

enum { NO_FACE = -1, UNSEEN = -2 };
enum { EDGE_LOW = EDGE_WINDOW }; // of a region where the wall is low

// An edge of the patch, run from its lower to its higher point number or the other way round, as the face on
// its left has it.
typedef struct crease {
    int32_t from, to;    // points of the patch
    int32_t left, right; // faces of the patch; right may be NO_FACE
} crease;

typedef struct piercing {
    const jali_patch *patch;
    jali_shell *shell;
    int32_t crease_count, low_end; // edges of the arrangement: creases, low regions, then the picture
    crease *crease;
    snapped s;
    triangulation plane;
    int32_t *face;    // [triangle_count] face of the patch each cell lies on
    uint8_t *tone;    // [triangle_count] 1 = void
    uint8_t *low;     // [triangle_count] 1 = low where solid
    double low_share; // of the thickness, from the inner skin; 1: there are no low regions
    int32_t *carrier; // [s.point_count] a crease that the place lies on, or -1
    int32_t *same;    // [s.point_count] itself, or the place on the other side of the seam
    int32_t *vertex;  // [s.point_count] vertex of the pierced shell, or -1: none yet
    double unit_mm;   // of the chart's lattice, for sentences
} piercing;

// --- Edges of the patch

static jali_status list_creases(jali_context *ctx, piercing *p)
{
    jali_status status;
    const jali_patch *patch = p->patch;
    sides linked = {0};
    TRY(sides_create(ctx, patch->point_count, patch->face_count, (const int32_t(*)[3])patch->corner,
                     &linked));
    TRY(ARENA(ctx, p->crease, 3 * (size_t)patch->face_count + 1));
    for (int32_t i = 0; i < 4 * patch->face_count; i++) {
        if ((i & 3) == 3 || (linked.beside[i] != NO_SIDE && linked.beside[i] < i)) continue;
        p->crease[p->crease_count++] =
            (crease){linked.corner[next_side(i)], linked.corner[last_side(i)], i >> 2,
                     linked.beside[i] == NO_SIDE ? NO_FACE : linked.beside[i] >> 2};
    }
done:
    sides_free(ctx, &linked);
    return status;
}

// --- The arrangement

static jali_status refuse_place(jali_context *ctx, const piercing *p, jali_status status, const int32_t at[2],
                                const char *what)
{
    return fail(ctx, status, "%s at (%.2f, %.2f) mm from the lower left of the picture's grid", what,
                at[0] * p->unit_mm, at[1] * p->unit_mm);
}

static void add_edges(const jali_contours *c, int32_t first, int32_t (*edge)[2], int32_t *count)
{
    for (int32_t k = 0; k < c->contour_count; k++)
        for (int32_t begin = c->first[k], end = c->first[k + 1], i = begin; i < end; i++, (*count)++) {
            edge[*count][0] = first + i;
            edge[*count][1] = first + (i + 1 < end ? i + 1 : begin);
        }
}

static void add_points(const jali_contours *c, int32_t (*point)[2], int32_t *count)
{
    if (c->point_count > 0) memcpy(point + *count, c->point, (size_t)c->point_count * sizeof *point);
    *count += c->point_count;
}

// Edges of the surface first, then of the low regions, then of the picture. Snap rounding tests for crossings
// what comes before a number; a crossing within the surface is its fault.
static jali_status arrange(jali_context *ctx, piercing *p, const jali_contours *picture,
                           const jali_contours *low)
{
    jali_status status;
    const jali_patch *patch = p->patch;
    int32_t(*point)[2], (*edge)[2], crossed[2], edges = 0, count = patch->point_count;
    size_t points =
        (size_t)patch->point_count + (size_t)picture->point_count + (size_t)(low ? low->point_count : 0);
    if (points + (size_t)p->crease_count > INT32_MAX / 4)
        return fail(ctx, JALI_LIMIT, "the picture and the surface have too many points: %zu", points);
    TRY(ARENA(ctx, point, points + 1));
    TRY(ARENA(ctx, edge, (size_t)p->crease_count + points + 1));
    memcpy(point, patch->point, (size_t)patch->point_count * sizeof *point);
    for (int32_t i = 0; i < p->crease_count; i++, edges++)
        edge[edges][0] = p->crease[i].from, edge[edges][1] = p->crease[i].to;
    if (low) {
        add_edges(low, count, edge, &edges);
        add_points(low, point, &count);
    }
    p->low_end = edges;
    add_edges(picture, count, edge, &edges);
    add_points(picture, point, &count);
    TRY(snap_round(ctx, (const int32_t(*)[2])point, (int32_t)points, (const int32_t(*)[2])edge, edges,
                   p->low_end, &p->s, crossed));
    if (crossed[0] >= 0 && crossed[1] < p->crease_count)
        TRY(refuse_place(ctx, p, JALI_NO_RESULT, patch->point[p->crease[crossed[0]].from],
                         "the surface covers the picture's window twice"));
done:
    return status;
}

static int32_t pieces_before(const piercing *p, int32_t edge)
{
    int32_t count = 0;
    while (count < p->s.piece_count && p->s.edge[count] < edge) count++;
    return count;
}

static int32_t pieces_of_creases(const piercing *p)
{
    return pieces_before(p, p->crease_count);
}

static jali_status insert_set(jali_context *ctx, piercing *p, int32_t from, int32_t to, uint8_t kind,
                              contact *met)
{
    jali_status status;
    int32_t(*odd)[2], count;
    TRY(ARENA(ctx, odd, to - from + 1));
    TRY(odd_pieces(ctx, (const int32_t(*)[2])p->s.piece + from, to - from, odd, &count));
    TRY(insert_edges(ctx, &p->plane, (const int32_t(*)[2])odd, count, kind, false, met));
done:
    return status;
}

static jali_status triangulate(jali_context *ctx, piercing *p)
{
    jali_status status;
    contact met;
    int32_t creases = pieces_of_creases(p), low = pieces_before(p, p->low_end);
    TRY(insert_points(ctx, &p->plane, (const int32_t(*)[2])p->s.point, p->s.point_count));
    TRY(insert_edges(ctx, &p->plane, (const int32_t(*)[2])p->s.piece, creases, EDGE_CREASE, false, &met));
    if (met.found == NO_CONTACT) TRY(insert_set(ctx, p, creases, low, EDGE_LOW, &met));
    if (met.found == NO_CONTACT) TRY(insert_set(ctx, p, low, p->s.piece_count, EDGE_CONTOUR, &met));
    if (met.found != NO_CONTACT)
        TRY(refuse_place(ctx, p, JALI_BROKEN, p->s.point[met.from], "edges still cross after snap rounding"));
done:
    return status;
}

// --- Faces of the cells

// Each piece of a crease tells the face on its left and on its right, unless another crease was snapped onto
// it; the rest follows from cell to cell. The order of the list of creases does not matter.
static jali_status label_faces(jali_context *ctx, piercing *p)
{
    jali_status status;
    const triangulation *plane = &p->plane;
    int32_t *waiting, depth = 0, creases = pieces_of_creases(p);
    uint8_t *shared;
    TRY(ARENA(ctx, p->face, plane->triangle_count + 1));
    TRY(ARENA(ctx, waiting, plane->triangle_count + 1));
    TRY(ARENA(ctx, shared, 4 * (size_t)plane->triangle_count + 1));
    memset(shared, 0, 4 * (size_t)plane->triangle_count);
    for (int32_t t = 0; t < plane->triangle_count; t++) p->face[t] = UNSEEN;
    for (int32_t i = 0; i < creases; i++) {
        int32_t s = side_between(plane, p->s.piece[i][0], p->s.piece[i][1]), o = plane->beside[s];
        shared[s] = shared[o] = (uint8_t)MIN(shared[s] + 1, 2);
    }
    for (int32_t i = 0; i < creases; i++) {
        const crease *c = &p->crease[p->s.edge[i]];
        int32_t s = side_between(plane, p->s.piece[i][0], p->s.piece[i][1]), o = plane->beside[s];
        if (shared[s] > 1) continue;
        if (p->face[s >> 2] == UNSEEN) waiting[depth++] = s >> 2;
        p->face[s >> 2] = c->left;
        if (p->face[o >> 2] == UNSEEN) waiting[depth++] = o >> 2;
        p->face[o >> 2] = c->right;
    }
    // First within the creases; what only shared pieces enclose then takes after its neighbours.
    for (int beyond = 0; beyond < 2; beyond++) {
        for (int32_t t = 0; t < plane->triangle_count && beyond; t++)
            if (p->face[t] != UNSEEN) waiting[depth++] = t;
        while (depth > 0) {
            int32_t t = waiting[--depth];
            for (int k = 0; k < 3; k++) {
                int32_t other = plane->beside[4 * t + k] >> 2;
                if (p->face[other] != UNSEEN || (!beyond && (plane->kind[4 * t + k] & EDGE_CREASE))) continue;
                p->face[other] = p->face[t];
                waiting[depth++] = other;
            }
        }
    }
done:
    return status;
}

static jali_status check_cover(jali_context *ctx, const piercing *p)
{
    for (int32_t t = 0; t < p->plane.triangle_count; t++)
        if (p->tone[t] && p->face[t] < 0 && !is_ghost(&p->plane, t))
            return refuse_place(ctx, p, JALI_NO_RESULT, p->plane.point[p->plane.corner[4 * t]],
                                "the picture reaches beyond the surface");
    return JALI_OK;
}

// --- Lifting

// The shares of a face's corners at a place.
static void shares_in_face(const piercing *p, int32_t face, const int32_t at[2], double share[3])
{
    const int32_t *corner = p->patch->corner[face], (*point)[2] = (const int32_t(*)[2])p->patch->point;
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double area = (double)orientation(point[corner[(k + 1) % 3]], point[corner[(k + 2) % 3]], at);
        share[k] = MAX(area, 0) * (p->patch->weight ? p->patch->weight[corner[k]] : 1);
        sum += share[k];
    }
    for (int k = 0; k < 3; k++) share[k] /= sum;
}

// The share of the end `to` at a place on a crease.
static double share_on_crease(const piercing *p, const crease *c, const int32_t at[2])
{
    const int32_t *a = p->patch->point[c->from], *b = p->patch->point[c->to];
    double dx = b[0] - a[0], dy = b[1] - a[1];
    double along = ((at[0] - a[0]) * dx + (at[1] - a[1]) * dy) / (dx * dx + dy * dy);
    along = MIN(MAX(along, 0), 1);
    if (!p->patch->weight) return along;
    double from = (1 - along) * p->patch->weight[c->from], to = along * p->patch->weight[c->to];
    return to / (from + to);
}

static void mix(const double (*v)[3], const int32_t *vertex, const double *share, int count, double unit_mm,
                double at[3])
{
    for (int k = 0; k < 3; k++) {
        double sum = 0;
        for (int i = 0; i < count; i++) sum += share[i] * v[vertex[i]][k];
        at[k] = rint(sum / unit_mm) * unit_mm;
    }
}

// The place as a vertex of both skins, made from those of the unpierced shell.
static void lift(const piercing *p, int32_t place, int32_t face, double outer[3], double inner[3])
{
    int32_t vertex[3];
    double share[3];
    int count;
    if (p->carrier[place] >= 0) {
        const crease *c = &p->crease[p->carrier[place]];
        count = 2;
        vertex[0] = p->patch->vertex[c->from];
        vertex[1] = p->patch->vertex[c->to];
        share[1] = share_on_crease(p, c, p->s.point[place]);
        share[0] = 1 - share[1];
    } else {
        count = 3;
        for (int k = 0; k < 3; k++) vertex[k] = p->patch->vertex[p->patch->corner[face][k]];
        shares_in_face(p, face, p->s.point[place], share);
    }
    const jali_shell *shell = p->shell;
    mix((const double(*)[3])shell->outer.mesh.vertex, vertex, share, count, shell->unit_mm, outer);
    mix((const double(*)[3])shell->inner, vertex, share, count, shell->unit_mm, inner);
}

static void lift_uv(const piercing *p, int32_t face, const int32_t at[2], double uv[2])
{
    double share[3];
    shares_in_face(p, face, at, share);
    const double(*corner)[2] = (const double(*)[2])p->shell->outer.uv[p->patch->face[face]];
    for (int k = 0; k < 2; k++)
        uv[k] = share[0] * corner[0][k] + share[1] * corner[1][k] + share[2] * corner[2][k];
}

static jali_status find_carriers(jali_context *ctx, piercing *p)
{
    jali_status status;
    TRY(ARENA(ctx, p->carrier, p->s.point_count + 1));
    TRY(ARENA(ctx, p->vertex, p->s.point_count + 1));
    for (int32_t i = 0; i < p->s.point_count; i++) p->carrier[i] = p->vertex[i] = -1;
    for (int32_t i = p->s.piece_count - 1; i >= 0; i--) // backwards: the lowest crease stays
        if (p->s.edge[i] < p->crease_count)
            p->carrier[p->s.piece[i][0]] = p->carrier[p->s.piece[i][1]] = p->s.edge[i];
    for (int32_t i = 0; i < p->patch->point_count; i++) p->vertex[p->s.home[i]] = p->patch->vertex[i];
done:
    return status;
}

// Where the chart is cut open, both sides of the cut have the same vertices at its ends: what comes in
// between on one side does so on the other, at the same height (the chart's seam is upright), and is one
// vertex too.
typedef struct seam_place {
    int32_t low, high; // vertices of the edge
    int32_t height, place;
} seam_place;

static int compare_seam_places(const void *left, const void *right)
{
    const seam_place *a = left, *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    if (a->height != b->height) return a->height < b->height ? -1 : 1;
    return a->place < b->place ? -1 : a->place > b->place;
}

static jali_status join_seam(jali_context *ctx, piercing *p)
{
    jali_status status;
    seam_place *seam;
    int32_t count = 0;
    TRY(ARENA(ctx, seam, p->s.point_count + 1));
    TRY(ARENA(ctx, p->same, p->s.point_count + 1));
    for (int32_t i = 0; i < p->s.point_count; i++) {
        p->same[i] = i;
        if (p->vertex[i] >= 0 || p->carrier[i] < 0) continue;
        const crease *c = &p->crease[p->carrier[i]];
        if (c->right != NO_FACE) continue;
        int32_t a = p->patch->vertex[c->from], b = p->patch->vertex[c->to];
        seam[count++] = (seam_place){MIN(a, b), MAX(a, b), p->s.point[i][1], i};
    }
    if (count) qsort(seam, (size_t)count, sizeof *seam, compare_seam_places);
    for (int32_t i = 1; i < count; i++)
        if (seam[i].low == seam[i - 1].low && seam[i].high == seam[i - 1].high &&
            seam[i].height == seam[i - 1].height)
            p->same[seam[i].place] = p->same[seam[i - 1].place];
done:
    return status;
}

// --- The pierced shell

static bool stays(const piercing *p, int32_t t, double backing)
{
    return p->face[t] >= 0 && (!p->tone[t] || backing > 0) && !is_ghost(&p->plane, t);
}

static jali_status room_for(jali_context *ctx, const piercing *p, double backing, jali_shell *out)
{
    jali_status status;
    const jali_mesh *old = &p->shell->outer.mesh;
    int64_t triangles = old->triangle_count - p->patch->face_count;
    for (int32_t t = 0; t < p->plane.triangle_count; t++) triangles += stays(p, t, backing);
    int64_t vertices = (int64_t)old->vertex_count + p->s.point_count;
    if (MAX(triangles, vertices) > INT32_MAX / 8)
        return fail(ctx, JALI_LIMIT, "the pierced surface would have %lld triangles", (long long)triangles);
    *out = (jali_shell){.unit_mm = p->shell->unit_mm,
                        .outer.around_mm = p->shell->outer.around_mm,
                        .outer.textured = p->shell->outer.textured};
    TRY(ALLOCATE(ctx, out->outer.mesh.triangle, triangles + 1));
    TRY(ALLOCATE(ctx, out->outer.mesh.vertex, vertices + 1));
    TRY(ALLOCATE(ctx, out->inner, vertices + 1));
    if (p->shell->outer.uv) TRY(ALLOCATE(ctx, out->outer.uv, triangles + 1));
    if (p->shell->outer.faulty) TRY(ALLOCATE_CLEARED(ctx, out->outer.faulty, triangles + 1));
    if (p->shell->solid || backing > 0 || p->low_share < 1) TRY(ALLOCATE(ctx, out->solid, triangles + 1));
    memcpy(out->outer.mesh.vertex, old->vertex, (size_t)old->vertex_count * sizeof *old->vertex);
    memcpy(out->inner, p->shell->inner, (size_t)old->vertex_count * sizeof *out->inner);
    out->outer.mesh.vertex_count = old->vertex_count;
done:
    if (status != JALI_OK) jali_shell_free(ctx, out);
    return status;
}

static void copy_solid(const jali_shell *from, int32_t t, jali_shell *to, int32_t into)
{
    if (!to->solid) return;
    to->solid[into][0] = from->solid ? from->solid[t][0] : 0;
    to->solid[into][1] = from->solid ? from->solid[t][1] : 1;
}

static void copy_untouched(const piercing *p, const uint8_t *covered, jali_shell *out)
{
    const jali_shell *old = p->shell;
    for (int32_t t = 0; t < old->outer.mesh.triangle_count; t++) {
        if (covered[t]) continue;
        int32_t into = out->outer.mesh.triangle_count++;
        memcpy(out->outer.mesh.triangle[into], old->outer.mesh.triangle[t], sizeof *old->outer.mesh.triangle);
        if (out->outer.uv) memcpy(out->outer.uv[into], old->outer.uv[t], sizeof *old->outer.uv);
        if (out->outer.faulty) out->outer.faulty[into] = old->outer.faulty[t];
        copy_solid(old, t, out, into);
    }
}

static void add_cell(piercing *p, int32_t t, double backing, jali_shell *out)
{
    jali_mesh *mesh = &out->outer.mesh;
    int32_t into = mesh->triangle_count++, face = p->face[t];
    for (int k = 0; k < 3; k++) {
        int32_t place = p->plane.corner[4 * t + k], same = p->same[place];
        if (p->vertex[same] < 0) {
            p->vertex[same] = mesh->vertex_count++;
            lift(p, place, face, mesh->vertex[p->vertex[same]], out->inner[p->vertex[same]]);
        }
        mesh->triangle[into][k] = p->vertex[same];
        if (out->outer.uv) lift_uv(p, face, p->s.point[place], out->outer.uv[into][k]);
    }
    if (out->outer.faulty) out->outer.faulty[into] = p->shell->outer.faulty[p->patch->face[face]];
    copy_solid(p->shell, p->patch->face[face], out, into);
    if (p->tone[t] && out->solid) out->solid[into][1] = (float)backing;
    if (!p->tone[t] && p->low[t] && out->solid)
        out->solid[into][1] = MIN(out->solid[into][1], (float)p->low_share);
}

static jali_status build(jali_context *ctx, piercing *p, double backing)
{
    jali_status status;
    jali_shell out = {0};
    uint8_t *covered;
    int32_t left;
    int32_t triangles = p->shell->outer.mesh.triangle_count;
    TRY(ARENA(ctx, covered, triangles + 1));
    memset(covered, 0, (size_t)triangles);
    for (int32_t i = 0; i < p->patch->face_count; i++) covered[p->patch->face[i]] = 1;
    TRY(room_for(ctx, p, backing, &out));
    copy_untouched(p, covered, &out);
    for (int32_t t = 0; t < p->plane.triangle_count; t++)
        if (stays(p, t, backing)) add_cell(p, t, backing, &out);
    TRY(mend_slivers(ctx, &out, SLIVER_UNITS * out.unit_mm, 0, &left));
    jali_shell_free(ctx, p->shell);
    *p->shell = out;
    out = (jali_shell){0};
done:
    jali_shell_free(ctx, &out);
    return status;
}

jali_status jali_pierce_stepped(jali_context *ctx, const jali_contours *picture, const jali_contours *low,
                                double low_share, const jali_patch *patch, double backing, jali_shell *shell)
{
    jali_status status;
    arena_mark mark = arena_here(ctx);
    piercing p = {
        .patch = patch, .shell = shell, .unit_mm = picture->unit_mm, .low_share = low ? low_share : 1};
    TRY(step(ctx, "carve", 0));
    TRY(list_creases(ctx, &p));
    TRY(arrange(ctx, &p, picture, low));
    TRY(step(ctx, "carve", 0.3));
    TRY(triangulate(ctx, &p));
    TRY(label_faces(ctx, &p));
    TRY(ARENA(ctx, p.tone, p.plane.triangle_count + 1));
    TRY(label_tones(ctx, &p.plane, EDGE_CONTOUR, p.tone));
    TRY(ARENA(ctx, p.low, p.plane.triangle_count + 1));
    TRY(label_tones(ctx, &p.plane, EDGE_LOW, p.low));
    TRY(check_cover(ctx, &p));
    TRY(find_carriers(ctx, &p));
    TRY(join_seam(ctx, &p));
    TRY(build(ctx, &p, backing));
    TRY(step(ctx, "carve", 0.8));
done:
    triangulation_free(ctx, &p.plane);
    snapped_free(ctx, &p.s);
    arena_rewind(ctx, mark);
    return status;
}

jali_status jali_pierce(jali_context *ctx, const jali_contours *picture, const jali_patch *patch,
                        double backing, jali_shell *shell)
{
    return jali_pierce_stepped(ctx, picture, NULL, 1, patch, backing, shell);
}
