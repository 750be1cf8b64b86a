// A pierced plate or shell, solved; built twice, with the sequential solver and with PETSc's.
//
//     plate write FILE CELLS RADIUS      displacements, as bytes
//     plate compare FILE CELLS RADIUS    solve again and compare: the largest difference must be below 1e-6
//
// RADIUS 0 is a flat plate, of which 3 unknowns a node are solved for; else a bent one, of 6.
#include "sheets.h"

#include "structure/assemble.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { WALL, CPU };
static const clockid_t clocks[] = {CLOCK_MONOTONIC, CLOCK_PROCESS_CPUTIME_ID};

static double begun[2], spent[3][2];

static double seconds_of(int which)
{
    struct timespec t;
    clock_gettime(clocks[which], &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void note(void *user, const char *stage, double fraction)
{
    static const char *const names[] = {"assemble", "order", "factor", "solve"};
    static const int column[] = {0, 1, 1, 2};
    (void)user;
    for (int i = 0; i < 4; i++) {
        if (strcmp(stage, names[i]) != 0) continue;
        for (int c = WALL; c <= CPU; c++) {
            if (fraction <= 0) begun[c] = seconds_of(c);
            if (fraction >= 1) spent[column[i]][c] += seconds_of(c) - begun[c];
        }
    }
}

// The largest difference from what stands in the file, relative.
static double compare(FILE *f, int32_t count, const double (*u)[NODE_UNKNOWNS])
{
    double other[NODE_UNKNOWNS], most = 0, apart = 0;
    for (int32_t i = 0; i < count; i++) {
        if (fread(other, sizeof other, 1, f) != 1) return INFINITY;
        for (int k = 0; k < 3; k++) {
            most = fmax(most, fabs(other[k]));
            apart = fmax(apart, fabs(other[k] - u[i][k]));
        }
    }
    return apart / most;
}

static jali_status run(jali_context *ctx, const char *verb, const char *path, int32_t cells, double radius_mm,
                       bool *good)
{
    jali_status status;
    pierced_options o = {
        .cells = cells, .holes = 8, .size_mm = 40, .hole_mm = 1.5, .thickness_mm = 2, .radius_mm = radius_mm};
    facet_material pla = {.e_mpa = 2300, .nu = 0.35};
    jali_sheet sheet;
    structure s = {0};
    uint8_t *held;
    double(*u)[NODE_UNKNOWNS];
    FILE *f = NULL;
    TRY(pierced_sheet(ctx, &o, &sheet));
    TRY(ARENA(ctx, held, sheet.node_count));
    TRY(ARENA(ctx, u, sheet.node_count));
    for (int32_t i = 0; i < sheet.node_count; i++) {
        held[i] = sheet.border[i] ? HELD_ALL : 0;
        for (int k = 0; k < NODE_UNKNOWNS; k++) u[i][k] = k == 2 ? -1e-3 : 0;
    }
    TRY(structure_create(ctx, &sheet, &pla, held, radius_mm == 0, &s));
    TRY(structure_solve(ctx, &s, 1, (const double(*)[NODE_UNKNOWNS])u, u));
    *good = true;
    if (!solver_leads()) goto done;
    bool writing = strcmp(verb, "write") == 0;
    f = fopen(path, writing ? "wb" : "rb");
    *good = f && (!writing || fwrite(u, sizeof *u, (size_t)sheet.node_count, f) == (size_t)sheet.node_count);
    double apart = *good && !writing ? compare(f, sheet.node_count, (const double(*)[NODE_UNKNOWNS])u) : 0;
    *good &= apart < 1e-6;
    printf("%9d unknowns, wall / CPU s: assemble %.2f / %.2f, order and factor %.2f / %.2f, solve %.2f / "
           "%.2f; residual "
           "%.0e, apart by %.0e\n",
           unknowns_of(&s.k), spent[0][WALL], spent[0][CPU], spent[1][WALL], spent[1][CPU], spent[2][WALL],
           spent[2][CPU], s.residual, apart);
done:
    if (f) fclose(f);
    structure_free(ctx, &s);
    drop_sheet(ctx, &sheet);
    return status;
}

int main(int argc, char **argv)
{
    jali_context *ctx;
    jali_context_options opt = jali_context_defaults();
    bool good = false;
    opt.threads = 1;
    opt.progress = note;
    if (argc != 5 || jali_context_create(&opt, &ctx) != JALI_OK) return 2;
    if (run(ctx, argv[1], argv[2], atoi(argv[3]), atof(argv[4]), &good) != JALI_OK)
        fprintf(stderr, "plate: %s\n", jali_message(ctx));
    jali_context_free(ctx);
    return good ? 0 : 1;
}
