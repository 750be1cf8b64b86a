// The same plate in CalculiX (ccx), when it is installed: its shells of three and of six nodes.
#include "calculix.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

bool calculix_there(void)
{
    return system("command -v ccx >/dev/null 2>&1") == 0;
}

static void write_list(FILE *f, int32_t count, const int32_t *item)
{
    for (int32_t i = 0; i < count; i++) fprintf(f, "%d%s", item[i] + 1, i + 1 < count ? ", " : "\n");
}

// The middle of each side gets a node: numbered as sides are met, found again in a table by their lower end.
typedef struct sides {
    int32_t count, *head, *next, (*end)[2];
} sides;

static int32_t side_node(sides *s, int32_t node_count, int32_t a, int32_t b)
{
    int32_t low = a < b ? a : b, high = a < b ? b : a;
    for (int32_t i = s->head[low]; i >= 0; i = s->next[i])
        if (s->end[i][1] == high) return node_count + i;
    s->end[s->count][0] = low;
    s->end[s->count][1] = high;
    s->next[s->count] = s->head[low];
    s->head[low] = s->count;
    return node_count + s->count++;
}

static void write_input(FILE *f, const jali_sheet *sheet, double e_mpa, double nu, double pressure_mpa,
                        bool six)
{
    int32_t n = sheet->node_count, t = sheet->triangle_count;
    sides s = {.head = malloc((size_t)n * 4), .next = malloc((size_t)t * 12), .end = malloc((size_t)t * 24)};
    int32_t(*element)[6] = malloc((size_t)t * sizeof *element);
    bool *used = calloc((size_t)n, 1);
    for (int32_t i = 0; i < n; i++) s.head[i] = -1;
    for (int32_t i = 0; i < t; i++)
        for (int k = 0; k < 3; k++) {
            const int32_t *corner = sheet->triangle[i];
            element[i][k] = corner[k];
            used[corner[k]] = true;
            if (six) element[i][3 + k] = side_node(&s, n, corner[k], corner[(k + 1) % 3]);
        }
    fprintf(f, "*NODE, NSET=ALL\n");
    for (int32_t i = 0; i < n; i++)
        if (used[i])
            fprintf(f, "%d, %.9g, %.9g, %.9g\n", i + 1, sheet->node[i][0], sheet->node[i][1],
                    sheet->node[i][2]);
    for (int32_t i = 0; i < s.count; i++) {
        const double *a = sheet->node[s.end[i][0]], *b = sheet->node[s.end[i][1]];
        fprintf(f, "%d, %.9g, %.9g, %.9g\n", n + i + 1, (a[0] + b[0]) / 2, (a[1] + b[1]) / 2,
                (a[2] + b[2]) / 2);
    }
    fprintf(f, "*ELEMENT, TYPE=%s, ELSET=PLATE\n", six ? "S6" : "S3");
    for (int32_t i = 0; i < t; i++) {
        fprintf(f, "%d, ", i + 1);
        write_list(f, six ? 6 : 3, element[i]);
    }
    fprintf(f, "*BOUNDARY\n");
    for (int32_t i = 0; i < n; i++)
        if (used[i] && sheet->border[i] & JALI_BORDER_RIM) fprintf(f, "%d, 1, 6\n", i + 1);
    for (int32_t i = 0; i < s.count; i++) { // a side along the rim has both ends on the same line of it
        const double *a = sheet->node[s.end[i][0]], *b = sheet->node[s.end[i][1]];
        bool rim = sheet->border[s.end[i][0]] & sheet->border[s.end[i][1]] & JALI_BORDER_RIM;
        if (rim && (a[0] == b[0] || a[1] == b[1])) fprintf(f, "%d, 1, 6\n", n + i + 1);
    }
    fprintf(f, "*MATERIAL, NAME=M\n*ELASTIC\n%g, %g\n*SHELL SECTION, ELSET=PLATE, MATERIAL=M\n%g\n", e_mpa,
            nu, sheet->thickness_mm[0]);
    fprintf(f, "*STEP\n*STATIC\n*DLOAD\nPLATE, P, %g\n*NODE PRINT, NSET=ALL\nU\n*END STEP\n", pressure_mpa);
    free(s.head), free(s.next), free(s.end), free(element), free(used);
}

static double children_seconds(void)
{
    struct rusage r;
    getrusage(RUSAGE_CHILDREN, &r);
    return (double)(r.ru_utime.tv_sec + r.ru_stime.tv_sec) +
           1e-6 * (double)(r.ru_utime.tv_usec + r.ru_stime.tv_usec);
}

static double largest_displacement(FILE *f)
{
    char line[256];
    double u[3], most = NAN;
    while (f && fgets(line, sizeof line, f))
        if (sscanf(line, "%*d %lf %lf %lf", &u[0], &u[1], &u[2]) == 3)
            for (int k = 0; k < 3; k++) most = fmax(most, fabs(u[k]));
    return most;
}

calculix_answer calculix_run(const jali_sheet *sheet, double e_mpa, double nu, double pressure_mpa, bool six)
{
    char folder[] = "/tmp/jali-ccx-XXXXXX", path[64], command[256];
    calculix_answer answer = {NAN, NAN};
    if (!mkdtemp(folder)) return answer;
    snprintf(path, sizeof path, "%s/plate.inp", folder);
    FILE *f = fopen(path, "w");
    if (!f) return answer;
    write_input(f, sheet, e_mpa, nu, pressure_mpa, six);
    fclose(f);
    double before = children_seconds();
    snprintf(command, sizeof command, "cd %s && OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 ccx plate >log 2>&1",
             folder);
    bool ran = system(command) == 0;
    answer.seconds = children_seconds() - before;
    snprintf(path, sizeof path, "%s/plate.dat", folder);
    f = ran ? fopen(path, "r") : NULL;
    answer.displacement_mm = largest_displacement(f);
    if (f) fclose(f);
    snprintf(command, sizeof command, "rm -r %s", folder);
    if (system(command) != 0) fprintf(stderr, "%s stays\n", folder);
    return answer;
}
