// The facet of a shell against what every facet must do: hold constant states, turn without strain, bend.
#include "testing.h"
#include "shell_model.h"
#include "mitc.h"

static const facet_material PLASTIC = {.e_mpa = 2300, .nu = 0.35, .thickness_mm = 1.7};

static double uniform(uint64_t *seed)
{
    return (double)(next_random(seed) >> 11) / 9007199254740992.0;
}

// A rotation matrix from three seeds; rows are unit vectors.
static void random_frame(uint64_t *seed, double frame[3][3])
{
    double node[3][3];
    for (int i = 0; i < 9; i++) node[i / 3][i % 3] = uniform(seed);
    facet_frame((const double(*)[3])node, frame);
}

static void random_triangle(uint64_t *seed, double size, double node[3][3])
{
    double frame[3][3], v[3];
    do {
        for (int i = 0; i < 9; i++) node[i / 3][i % 3] = size * (uniform(seed) - 0.5);
        for (int k = 0; k < 3; k++) {
            int a = (k + 1) % 3, b = (k + 2) % 3;
            v[k] = (node[1][a] - node[0][a]) * (node[2][b] - node[0][b]) -
                   (node[1][b] - node[0][b]) * (node[2][a] - node[0][a]);
        }
    } while (sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) < 0.05 * size * size);
    facet_frame((const double(*)[3])node, frame);
}

static double largest(const double *value, int count)
{
    double most = 0;
    for (int i = 0; i < count; i++) most = MAX(most, fabs(value[i]));
    return most;
}

// Eigenvalues by Jacobi's rotations.
static void eigenvalues(int n, double a[18][18], double value[18])
{
    for (int sweep = 0; sweep < 60; sweep++)
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++) {
                if (a[p][q] == 0) continue;
                double theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
                double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
                double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int i = 0; i < n; i++) {
                    double x = a[i][p], y = a[i][q];
                    a[i][p] = c * x - s * y;
                    a[i][q] = s * x + c * y;
                }
                for (int i = 0; i < n; i++) {
                    double x = a[p][i], y = a[q][i];
                    a[p][i] = c * x - s * y;
                    a[q][i] = s * x + c * y;
                }
            }
    for (int i = 0; i < n; i++) value[i] = a[i][i];
}

// Unknowns in lengths of the facet alone, so that eigenvalues can be compared.
static void even_out(double k[18][18], double size)
{
    for (int i = 0; i < 18; i++)
        for (int j = 0; j < 18; j++) k[i][j] /= (i / 3 % 2 ? size : 1) * (j / 3 % 2 ? size : 1);
}

TEST(facets_have_twelve_strains_and_six_rigid_motions)
{
    uint64_t seed = 7;
    for (int round = 0; round < 60; round++) {
        double node[3][3], k[18][18], value[18];
        facet_material made_of = PLASTIC;
        made_of.thickness_mm = pow(10, 4 * uniform(&seed) - 3);
        made_of.nu = 0.499 * uniform(&seed);
        random_triangle(&seed, 1, node);
        facet_stiffness((const double(*)[3])node, &made_of, k);
        for (int i = 0; i < 18; i++)
            for (int j = 0; j < 18; j++) CHECK(k[i][j] == k[j][i]);
        even_out(k, 1);
        eigenvalues(18, k, value);
        double most = largest(value, 18), least = INFINITY;
        int none = 0;
        for (int i = 0; i < 18; i++) {
            CHECK(value[i] > -1e-13 * most);
            if (fabs(value[i]) < 1e-13 * most)
                none++;
            else
                least = MIN(least, value[i]);
        }
        CHECK_INT(none, 6);
        CHECK(least > 0);
    }
}

TEST(rigid_motions_cost_nothing)
{
    uint64_t seed = 11;
    for (int round = 0; round < 200; round++) {
        double node[3][3], k[18][18], u[18], force[18];
        random_triangle(&seed, 3, node);
        facet_stiffness((const double(*)[3])node, &PLASTIC, k);
        for (int mode = 0; mode < 6; mode++) {
            for (int i = 0; i < 3; i++)
                for (int c = 0; c < 3; c++) {
                    int a = (mode + 1) % 3, b = (mode + 2) % 3; // rotation about axis mode - 3
                    u[6 * i + c] = mode < 3 ? c == mode : c == b ? node[i][a] : c == a ? -node[i][b] : 0;
                    u[6 * i + 3 + c] = mode >= 3 && c == mode - 3;
                }
            double scale = largest(k[0], 18 * 18) * largest(u, 18);
            for (int i = 0; i < 18; i++) {
                force[i] = 0;
                for (int j = 0; j < 18; j++) force[i] += k[i][j] * u[j];
            }
            CHECK(largest(force, 18) < 1e-12 * scale);
            resultants at[3];
            facet_resultants((const double(*)[3])node, &PLASTIC, u, at);
            CHECK(largest(&at[0].n[0], 24) < 1e-11 * PLASTIC.e_mpa * largest(u, 18));
        }
    }
}

// A state of strain in the plane of a facet: displacements linear, deflection quadratic.
typedef struct strained {
    double stretch[2][3]; // u, v = a + b x + c y
    double curve[3];      // w = (a x^2 + b y^2 + 2 c x y) / 2
    double frame[3][3];   // the plane's axes
} strained;

static void unknowns_in(const strained *s, const double at[3], double u[6])
{
    double p[2] = {0, 0}, own[6];
    for (int c = 0; c < 3; c++) p[0] += s->frame[0][c] * at[c], p[1] += s->frame[1][c] * at[c];
    for (int k = 0; k < 2; k++) own[k] = s->stretch[k][0] + s->stretch[k][1] * p[0] + s->stretch[k][2] * p[1];
    own[2] = 0.5 * (s->curve[0] * p[0] * p[0] + s->curve[1] * p[1] * p[1]) + s->curve[2] * p[0] * p[1];
    own[3] = s->curve[1] * p[1] + s->curve[2] * p[0];
    own[4] = -(s->curve[0] * p[0] + s->curve[2] * p[1]);
    own[5] = 0.5 * (s->stretch[1][1] - s->stretch[0][2]);
    for (int c = 0; c < 3; c++) {
        u[c] = u[3 + c] = 0;
        for (int k = 0; k < 3; k++) {
            u[c] += s->frame[k][c] * own[k];
            u[3 + c] += s->frame[k][c] * own[3 + k];
        }
    }
}

static strained random_state(uint64_t *seed)
{
    strained s;
    random_frame(seed, s.frame);
    for (int i = 0; i < 6; i++) s.stretch[i / 3][i % 3] = uniform(seed) - 0.5;
    for (int i = 0; i < 3; i++) s.curve[i] = uniform(seed) - 0.5;
    return s;
}

// Symmetric parts in the plane's axes against a tensor in a facet's, by the trace and the determinant.
static void check_tensor(const double got[3], const double wanted[3], double scale)
{
    CHECK(fabs(got[0] + got[1] - wanted[0] - wanted[1]) < 1e-10 * scale);
    CHECK(fabs(got[0] * got[1] - got[2] * got[2] - wanted[0] * wanted[1] + wanted[2] * wanted[2]) <
          1e-10 * scale * scale);
}

// Any mesh in any plane: nodes inside feel no force, and every corner the same stress.
static void check_patch(stiffness_of *element, uint64_t *seed)
{
    strained s = random_state(seed);
    shell_model m = grid_model(4, 4, CROSSED, PLASTIC);
    double(*force)[6] = zeros((size_t)m.node_count, sizeof *force), scale = 0, flat[6];
    for (int32_t n = 0; n < m.node_count; n++) {
        double p[2] = {m.node[n][0] + 0.12 * (uniform(seed) - 0.5),
                       m.node[n][1] + 0.12 * (uniform(seed) - 0.5)};
        for (int c = 0; c < 3; c++) m.node[n][c] = s.frame[0][c] * p[0] * 9 + s.frame[1][c] * p[1] * 5;
        unknowns_in(&s, m.node[n], m.u[n]);
    }
    plane_stress p = plane_stress_of(&PLASTIC);
    double h = PLASTIC.thickness_mm, bends = -h * h * h / 12;
    double strain[3] = {s.stretch[0][1], s.stretch[1][2], s.stretch[0][2] + s.stretch[1][1]};
    double curve[3] = {s.curve[0], s.curve[1], 2 * s.curve[2]};
    stress_of(p, strain, flat);
    stress_of(p, curve, flat + 3);
    for (int i = 0; i < 3; i++) flat[i] *= h, flat[3 + i] *= bends;
    for (int32_t t = 0; t < m.triangle_count; t++) {
        double at[3][3], k[18][18], u[18];
        corners_of(&m, t, at);
        element((const double(*)[3])at, &PLASTIC, k);
        scale = MAX(scale, largest(k[0], 18 * 18));
        for (int i = 0; i < 18; i++) u[i] = m.u[m.triangle[t][i / 6]][i % 6];
        for (int i = 0; i < 18; i++)
            for (int j = 0; j < 18; j++) force[m.triangle[t][i / 6]][i % 6] += k[i][j] * u[j];
        if (element != facet_stiffness) continue;
        resultants corner[3];
        facet_resultants((const double(*)[3])at, &PLASTIC, u, corner);
        for (int c = 0; c < 3; c++) {
            check_tensor(corner[c].n, flat, 10 * PLASTIC.e_mpa);
            check_tensor(corner[c].m, flat + 3, 10 * PLASTIC.e_mpa);
            CHECK(largest(corner[c].q, 2) < 1e-9 * PLASTIC.e_mpa);
        }
    }
    for (int32_t n = 0; n < m.node_count; n++)
        if (m.place[n][0] > 0 && m.place[n][0] < 1 && m.place[n][1] > 0 && m.place[n][1] < 1)
            CHECK(largest(force[n], 6) < 1e-11 * scale);
    free(force);
    model_free(&m);
}

TEST(patches_of_any_triangles_hold_constant_strain_and_curvature)
{
    uint64_t seed = 23;
    for (int round = 0; round < 40; round++) check_patch(facet_stiffness, &seed);
    for (int round = 0; round < 10; round++) check_patch(mitc_stiffness, &seed);
}

// Thick beyond measure nothing bends: normals at rest and a slope give the same shear everywhere.
TEST(shear_is_constant_where_nothing_bends)
{
    uint64_t seed = 29;
    facet_material thick = PLASTIC;
    thick.thickness_mm = 1e6;
    for (int round = 0; round < 50; round++) {
        strained s = random_state(&seed);
        double node[3][3], u[18] = {0}, slope[2] = {uniform(&seed), uniform(&seed)};
        for (int i = 0; i < 3; i++)
            for (int c = 0; c < 3; c++) node[i][c] = 0;
        double flat[3][2] = {
            {0, 0}, {1 + uniform(&seed), uniform(&seed)}, {-uniform(&seed), 1 + uniform(&seed)}};
        for (int i = 0; i < 3; i++)
            for (int c = 0; c < 3; c++) {
                node[i][c] = flat[i][0] * s.frame[0][c] + flat[i][1] * s.frame[1][c];
                u[6 * i + c] = (slope[0] * flat[i][0] + slope[1] * flat[i][1]) * s.frame[2][c];
            }
        resultants at[3];
        facet_resultants((const double(*)[3])node, &thick, u, at);
        double stiff = 5. / 6 * thick.thickness_mm * thick.e_mpa / (2 * (1 + thick.nu));
        for (int c = 0; c < 3; c++)
            CHECK(fabs(hypot(at[c].q[0], at[c].q[1]) / stiff - hypot(slope[0], slope[1])) < 1e-9);
    }
}

TEST(the_centre_has_the_mean_of_the_corners)
{
    uint64_t seed = 37;
    for (int round = 0; round < 200; round++) {
        double node[3][3], frame[3][3], u[18];
        resultants at[3], centre;
        random_triangle(&seed, 3, node);
        for (int i = 0; i < 18; i++) u[i] = 2 * uniform(&seed) - 1;
        facet_resultants((const double(*)[3])node, &PLASTIC, u, at);
        facet_frame((const double(*)[3])node, frame);
        facet_centre((const double(*)[3])node, (const double(*)[3])frame, &PLASTIC, u, &centre);
        double scale = largest(&at[0].n[0], 24);
        const double *mean = &centre.n[0], *a = &at[0].n[0], *b = &at[1].n[0], *c = &at[2].n[0];
        for (int i = 0; i < 8; i++) CHECK(fabs(mean[i] - (a[i] + b[i] + c[i]) / 3) < 1e-12 * scale);
    }
}

TEST(numbering_and_axes_do_not_matter)
{
    uint64_t seed = 31;
    for (int round = 0; round < 60; round++) {
        double node[3][3], moved[3][3], turn[3][3], k[18][18], other[18][18];
        random_triangle(&seed, 2, node);
        random_frame(&seed, turn);
        int shift = round % 3;
        for (int i = 0; i < 3; i++)
            for (int c = 0; c < 3; c++) {
                moved[i][c] = 5;
                for (int d = 0; d < 3; d++) moved[i][c] += turn[c][d] * node[(i + shift) % 3][d];
            }
        if (round % 2) // the other way round: the normal looks down, nothing else changes
            for (int c = 0; c < 3; c++) {
                double swap = moved[1][c];
                moved[1][c] = moved[2][c];
                moved[2][c] = swap;
            }
        facet_stiffness((const double(*)[3])node, &PLASTIC, k);
        facet_stiffness((const double(*)[3])moved, &PLASTIC, other);
        double scale = largest(k[0], 18 * 18);
        for (int i = 0; i < 18; i++)
            for (int j = 0; j < 18; j++) {
                int from[2] = {i / 6, j / 6};
                for (int e = 0; e < 2; e++) {
                    if (round % 2 && from[e]) from[e] = 3 - from[e];
                    from[e] = (from[e] + shift) % 3;
                }
                double wanted = 0;
                for (int a = 0; a < 3; a++)
                    for (int b = 0; b < 3; b++)
                        wanted += turn[i % 3][a] * turn[j % 3][b] *
                                  k[6 * from[0] + i % 6 / 3 * 3 + a][6 * from[1] + j % 6 / 3 * 3 + b];
                CHECK(fabs(other[i][j] - wanted) < 1e-12 * scale);
            }
    }
}

TEST(plates_are_the_bending_of_facets)
{
    uint64_t seed = 37;
    static const int bends[3] = {2, 3, 4};
    for (int round = 0; round < 50; round++) {
        double node[3][3] = {{0}}, flat[3][2], k[18][18], plate[9][9];
        for (int i = 0; i < 3; i++)
            for (int c = 0; c < 2; c++) flat[i][c] = 0.4 * uniform(&seed) + (i == c + 1);
        for (int i = 0; i < 3; i++) memcpy(node[i], flat[i], sizeof flat[i]);
        facet_stiffness((const double(*)[3])node, &PLASTIC, k);
        plate_stiffness((const double(*)[2])flat, &PLASTIC, plate);
        for (int i = 0; i < 9; i++)
            for (int j = 0; j < 9; j++)
                CHECK(fabs(plate[i][j] - k[i / 3 * 6 + bends[i % 3]][j / 3 * 6 + bends[j % 3]]) <
                      1e-12 * largest(plate[0], 81));
    }
}

// Energy of the unknowns of a model, and the forces that hold them.
static double energy_of(const shell_model *m, double (*force)[6])
{
    double energy = 0;
    memset(force, 0, (size_t)m->node_count * sizeof *force);
    for (int32_t t = 0; t < m->triangle_count; t++) {
        double at[3][3], k[18][18];
        const int32_t *n = m->triangle[t];
        corners_of(m, t, at);
        m->element((const double(*)[3])at, &m->made_of, k);
        for (int i = 0; i < 18; i++)
            for (int j = 0; j < 18; j++) {
                force[n[i / 6]][i % 6] += k[i][j] * m->u[n[j / 6]][j % 6];
                energy += 0.5 * k[i][j] * m->u[n[i / 6]][i % 6] * m->u[n[j / 6]][j % 6];
            }
    }
    return energy;
}

// A row of rectangles, two triangles each, bent in its plane as a beam: the energy and the moment at the end
// are those of the beam, and nodes between feel nothing, however slender the rectangles are.
TEST(rectangles_bend_exactly_in_their_plane)
{
    const double aspects[] = {0.1, 0.5, 1, 4, 16}, nus[] = {0, 0.3, 0.49};
    for (int combination = 0; combination < 30; combination++) {
        double aspect = aspects[combination % 5], nu = nus[combination / 5 % 3];
        facet_material made_of = {.e_mpa = 100, .nu = nu, .thickness_mm = 0.5};
        shell_model m = grid_model(3, 1, combination / 15 ? FALLING : RISING, made_of);
        double high = 2, cell = high * aspect, curve = 0.01, force[8][6], end = 0;
        double exact = curve * made_of.e_mpa * made_of.thickness_mm * high * high * high / 12;
        for (int32_t n = 0; n < 8; n++) {
            double x = 3 * cell * m.place[n][0], y = high * (m.place[n][1] - 0.5);
            m.node[n][0] = x;
            m.node[n][1] = y;
            m.u[n][0] = -curve * x * y;
            m.u[n][1] = 0.5 * curve * (x * x + nu * y * y);
            m.u[n][5] = curve * x;
        }
        double energy = energy_of(&m, force);
        CHECK(fabs(energy / (0.5 * exact * curve * 3 * cell) - 1) < 1e-9);
        for (int32_t n = 0; n < 8; n++) {
            if (m.place[n][0] == 1) end += force[n][5] - force[n][0] * m.node[n][1];
            bool between = n % 4 == 1 || n % 4 == 2;
            if (between) CHECK(largest(force[n], 5) < 1e-9 * exact);
            if (between && n < 4) CHECK(fabs(force[n][5] + force[n + 4][5]) < 1e-9 * exact);
        }
        CHECK(fabs(end / exact - 1) < 1e-9);
        model_free(&m);
    }
}

// Out of its plane, a cylinder's bending is constant curvature and as exact.
TEST(rectangles_bend_exactly_out_of_their_plane)
{
    const double aspects[] = {0.1, 0.5, 1, 4, 16};
    for (int a = 0; a < 5; a++) {
        facet_material made_of = {.e_mpa = 100, .nu = 0.3, .thickness_mm = 0.5};
        shell_model m = grid_model(3, 1, RISING, made_of);
        double high = 2, cell = high * aspects[a], curve = 0.01, force[8][6];
        double stiff = made_of.e_mpa * 0.125 / 12 * high; // a beam: free to bend across
        for (int32_t n = 0; n < 8; n++) {
            double x = 3 * cell * m.place[n][0], y = high * (m.place[n][1] - 0.5);
            m.node[n][0] = x;
            m.node[n][1] = y;
            m.u[n][2] = 0.5 * curve * (x * x - 0.3 * y * y);
            m.u[n][3] = -0.3 * curve * y;
            m.u[n][4] = -curve * x;
        }
        CHECK(fabs(energy_of(&m, force) / (0.5 * stiff * curve * curve * 3 * cell) - 1) < 1e-9);
        model_free(&m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facets_have_twelve_strains_and_six_rigid_motions),
        cmocka_unit_test(rigid_motions_cost_nothing),
        cmocka_unit_test(patches_of_any_triangles_hold_constant_strain_and_curvature),
        cmocka_unit_test(shear_is_constant_where_nothing_bends),
        cmocka_unit_test(the_centre_has_the_mean_of_the_corners),
        cmocka_unit_test(numbering_and_axes_do_not_matter),
        cmocka_unit_test(plates_are_the_bending_of_facets),
        cmocka_unit_test(rectangles_bend_exactly_in_their_plane),
        cmocka_unit_test(rectangles_bend_exactly_out_of_their_plane),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
