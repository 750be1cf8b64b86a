// The same plate in CalculiX (ccx), when it is installed.
//
// Limits:  flat sheets of one thickness, under pressure, clamped.
#include "calculix.h"
#include "calculix_read.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

bool calculix_there(void)
{
    return system("command -v ccx >/dev/null 2>&1") == 0;
}

// The middle of each side gets a node: numbered as sides are met, found again in a table by their lower end.
typedef struct sides {
    int32_t count, *head, *next, (*end)[2];
    uint8_t *triangles; // that share it
} sides;

static int32_t side_of(sides *s, int32_t a, int32_t b)
{
    int32_t low = a < b ? a : b, high = a < b ? b : a;
    for (int32_t i = s->head[low]; i >= 0; i = s->next[i])
        if (s->end[i][1] == high) return i;
    s->end[s->count][0] = low;
    s->end[s->count][1] = high;
    s->next[s->count] = s->head[low];
    s->head[low] = s->count;
    return s->count++;
}

// Corners and sides of a sheet's triangles, and which of both are held.
typedef struct net {
    int32_t (*element)[6]; // [triangle_count] three nodes, three sides
    bool *used;            // [node_count]
    sides sides;
} net;

static net net_of(const jali_sheet *sheet)
{
    int32_t n = sheet->node_count, t = sheet->triangle_count;
    net m = {.element = malloc((size_t)t * sizeof *m.element), .used = calloc((size_t)n, 1)};
    m.sides = (sides){.head = malloc((size_t)n * 4),
                      .next = malloc((size_t)t * 12),
                      .end = malloc((size_t)t * 24),
                      .triangles = calloc((size_t)t, 3)};
    for (int32_t i = 0; i < n; i++) m.sides.head[i] = -1;
    for (int32_t i = 0; i < t; i++)
        for (int k = 0; k < 3; k++) {
            const int32_t *corner = sheet->triangle[i];
            m.element[i][k] = corner[k];
            m.used[corner[k]] = true;
            m.element[i][3 + k] = side_of(&m.sides, corner[k], corner[(k + 1) % 3]);
            m.sides.triangles[m.element[i][3 + k]]++;
        }
    return m;
}

static void net_free(net *m)
{
    free(m->sides.head), free(m->sides.next), free(m->sides.end), free(m->sides.triangles);
    free(m->element), free(m->used);
}

// A side of the border between two clamped nodes is clamped as well.
static bool side_held(const calculix_case *c, const net *m, int32_t side)
{
    const int32_t *end = m->sides.end[side];
    return m->sides.triangles[side] == 1 && c->sheet->border[end[0]] & c->held &&
           c->sheet->border[end[1]] & c->held;
}

static void write_nodes(FILE *f, const calculix_case *c, const net *m, int32_t first, bool with_sides,
                        double z_mm)
{
    int32_t n = c->sheet->node_count;
    for (int32_t i = 0; i < n; i++)
        if (m->used[i])
            fprintf(f, "%d, %.9g, %.9g, %.9g\n", first + i, c->sheet->node[i][0], c->sheet->node[i][1], z_mm);
    for (int32_t i = 0; with_sides && i < m->sides.count; i++) {
        const double *a = c->sheet->node[m->sides.end[i][0]], *b = c->sheet->node[m->sides.end[i][1]];
        fprintf(f, "%d, %.9g, %.9g, %.9g\n", first + n + i, (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, z_mm);
    }
}

static void write_clamps(FILE *f, const calculix_case *c, const net *m, int32_t first, bool with_sides,
                         int unknowns)
{
    int32_t n = c->sheet->node_count;
    for (int32_t i = 0; i < n; i++)
        if (m->used[i] && c->sheet->border[i] & c->held) fprintf(f, "%d, 1, %d\n", first + i, unknowns);
    for (int32_t i = 0; with_sides && i < m->sides.count; i++)
        if (side_held(c, m, i)) fprintf(f, "%d, 1, %d\n", first + n + i, unknowns);
}

static void write_shells(FILE *f, const calculix_case *c, const net *m)
{
    bool six = c->kind == CALCULIX_S6;
    double t = c->sheet->thickness_mm[0];
    fprintf(f, "*NODE\n");
    write_nodes(f, c, m, 1, six, t / 2);
    fprintf(f, "*ELEMENT, TYPE=%s, ELSET=PLATE\n", six ? "S6" : "S3");
    for (int32_t i = 0; i < c->sheet->triangle_count; i++) {
        fprintf(f, "%d", i + 1);
        for (int k = 0; k < (six ? 6 : 3); k++)
            fprintf(f, ", %d", m->element[i][k] + 1 + (k < 3 ? 0 : c->sheet->node_count));
        fprintf(f, "\n");
    }
    fprintf(f, "*BOUNDARY\n");
    write_clamps(f, c, m, 1, six, 6);
    fprintf(f, "*SHELL SECTION, ELSET=PLATE, MATERIAL=M\n%.9g\n", t);
}

// Nodes by levels from the bottom: corners on each, sides on every other one.
static void write_wedges(FILE *f, const calculix_case *c, const net *m)
{
    int32_t n = c->sheet->node_count, count = c->sheet->triangle_count, level = n + m->sides.count;
    double t = c->sheet->thickness_mm[0];
    fprintf(f, "*NODE\n");
    for (int32_t l = 0; l <= 2 * c->layers; l++)
        write_nodes(f, c, m, 1 + l * level, l % 2 == 0, l * t / (2 * c->layers));
    for (int32_t layer = 0; layer < c->layers; layer++) {
        fprintf(f, "*ELEMENT, TYPE=C3D15, ELSET=%s\n", layer + 1 < c->layers ? "BODY" : "PLATE");
        for (int32_t i = 0; i < count; i++) {
            static const int order[15][2] = {{0, 0}, {1, 0}, {2, 0}, {0, 2}, {1, 2}, {2, 2}, {3, 0}, {4, 0},
                                             {5, 0}, {3, 2}, {4, 2}, {5, 2}, {0, 1}, {1, 1}, {2, 1}};
            fprintf(f, "%d", layer * count + i + 1);
            for (int k = 0; k < 15; k++) {
                int which = order[k][0];
                fprintf(f, ",%s%d", k == 8 ? "\n" : " ",
                        1 + (2 * layer + order[k][1]) * level + m->element[i][which] + (which < 3 ? 0 : n));
            }
            fprintf(f, "\n");
        }
    }
    fprintf(f, "*BOUNDARY\n");
    for (int32_t l = 0; l <= 2 * c->layers; l++) write_clamps(f, c, m, 1 + l * level, l % 2 == 0, 3);
    if (c->layers > 1) fprintf(f, "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n");
    fprintf(f, "*SOLID SECTION, ELSET=PLATE, MATERIAL=M\n");
}

static void write_input(FILE *f, const calculix_case *c)
{
    net m = net_of(c->sheet);
    fprintf(f, "*MATERIAL, NAME=M\n*ELASTIC\n%.9g, %.9g\n", c->e_mpa, c->nu);
    if (c->kind == CALCULIX_WEDGES)
        write_wedges(f, c, &m);
    else
        write_shells(f, c, &m);
    // Pressure on a shell acts along its normal; on the top of a wedge, inwards.
    fprintf(f, "*STEP\n*STATIC\n*DLOAD\nPLATE, %s, %.9g\n", c->kind == CALCULIX_WEDGES ? "P2" : "P",
            c->kind == CALCULIX_WEDGES ? c->pressure_mpa : -c->pressure_mpa);
    fprintf(f, "*NODE FILE, OUTPUT=3D\nU\n*EL FILE, OUTPUT=3D\nS\n*END STEP\n");
    net_free(&m);
}

static double children_seconds(void)
{
    struct rusage r;
    getrusage(RUSAGE_CHILDREN, &r);
    return (double)(r.ru_utime.tv_sec + r.ru_stime.tv_sec) +
           1e-6 * (double)(r.ru_utime.tv_usec + r.ru_stime.tv_usec);
}

calculix_answer calculix_run(const calculix_case *c)
{
    char folder[] = "/tmp/jali-ccx-XXXXXX", path[64], command[256];
    calculix_answer answer = {.displacement_mm = NAN, .seconds = NAN};
    if (!mkdtemp(folder)) return answer;
    snprintf(path, sizeof path, "%s/plate.inp", folder);
    FILE *f = fopen(path, "w");
    if (!f) return answer;
    write_input(f, c);
    fclose(f);
    double before = children_seconds();
    snprintf(command, sizeof command, "cd %s && OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 ccx plate >log 2>&1",
             folder);
    bool ran = system(command) == 0;
    double seconds = children_seconds() - before;
    snprintf(path, sizeof path, "%s/plate.frd", folder);
    f = ran ? fopen(path, "r") : NULL;
    if (f) {
        answer = calculix_read(f, c->sheet);
        fclose(f);
    }
    answer.seconds = seconds;
    snprintf(command, sizeof command, "rm -r %s", folder);
    if (system(command) != 0) fprintf(stderr, "%s stays\n", folder);
    return answer;
}
