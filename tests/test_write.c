// Writing: what was written reads back the same, byte for byte each time, and never replaces a file by half
//          of one.
#include "shapes.h"

#include <jali/check.h>
#include <jali/model.h>
#include <jali/png.h>
#include <jali/write.h>
#include "base/file.h"
#include "base/number.h"

#include <fcntl.h>
#include <png.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

// A folder of its own for each test.
static char folder[64];

static int open_folder(void **state)
{
    strcpy(folder, "/tmp/jali-test-XXXXXX");
    return mkdtemp(folder) && open_context(state) == 0 ? 0 : -1;
}

static int close_folder(void **state)
{
    char command[256];
    snprintf(command, sizeof command, "chmod -R u+w %s && rm -rf %s", folder, folder);
    return system(command) | close_context(state);
}

static const char *in_folder(const char *name)
{
    static char path[4][160];
    static int next;
    next = (next + 1) % 4;
    snprintf(path[next], sizeof path[next], "%s/%s", folder, name);
    return path[next];
}

static int32_t files_in_folder(void)
{
    char command[128], line[32] = "";
    snprintf(command, sizeof command, "ls -A %s | wc -l", folder);
    FILE *pipe = popen(command, "r");
    CHECK(pipe && fgets(line, sizeof line, pipe));
    pclose(pipe);
    return atoi(line);
}

static bool succeeds(const char *format, const char *path)
{
    char command[512];
    snprintf(command, sizeof command, format, path);
    return system(command) == 0;
}

static bool same_bytes(const jali_bytes *a, const jali_bytes *b)
{
    return a->size == b->size && memcmp(a->data, b->data, a->size) == 0;
}

static jali_contours ring(void)
{
    static const int32_t point[][2] = {{0, 0},       {81920, 0},   {81920, 40960}, {0, 40960},
                                       {1024, 1024}, {1024, 2047}, {2048, 1024}};
    jali_contours c = {.contour_count = 2, .point_count = 7, .unit_mm = 1.0 / 1024};
    CHECK_OK(ALLOCATE(ctx, c.first, 3));
    CHECK_OK(ALLOCATE(ctx, c.point, 7));
    memcpy(c.first, (int32_t[]){0, 4, 7}, 3 * sizeof *c.first);
    memcpy(c.point, point, sizeof point);
    return c;
}

static void free_ring(jali_contours *c)
{
    release(ctx, c->first);
    release(ctx, c->point);
}

TEST(decimals_read_back_the_same)
{
    uint64_t seed = 9;
    for (int i = 0; i < 300000; i++) {
        char text[DECIMAL_BYTES + 1];
        double value;
        uint64_t bits = next_random(&seed);
        uint32_t low = (uint32_t)(bits >> 32);
        float single;
        switch (i % 4) {
        case 0: memcpy(&value, &bits, sizeof value); break;
        case 1: memcpy(&single, &low, sizeof single), value = single; break;
        case 2: value = (double)((int64_t)bits >> 40) / 1024; break;
        default: value = (float)((double)(bits >> 11) * 0x1p-53 * 200 - 100); break;
        }
        if (!isfinite(value)) continue;
        int length = write_decimal(text, value);
        CHECK(length <= DECIMAL_BYTES);
        text[length] = 0;
        double back = strtod(text, NULL);
        if (i % 4 == 0 && value != (double)(float)value) CHECK(back == value);
        CHECK(strtof(text, NULL) == (float)value || !isfinite((float)value));
    }
    static const struct {
        double value;
        const char *text;
    } known[] = {
        {0, "0"},
        {-1.5, "-1.5"},
        {1.0 / 1024, "0.0009765625"},
        {12345.0 / 131072, "0.094184875"},
        {0.1f, "0.1"},
        {-33.3f, "-33.3"},
        {1e-7f, "1.00000e-07"},
        {0.1, "0.1"},
        {-0.107, "-0.107"},
        {1.0 / 3, "3.333333333333333e-01"},
        {16777216, "16777216"},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char text[DECIMAL_BYTES + 1];
        text[write_decimal(text, known[i].value)] = 0;
        assert_string_equal(text, known[i].text);
    }
}

TEST(models_read_back_the_same)
{
    jali_mesh meshes[3] = {pierced_plate(7, 1.25, 5), torus(20, 10), box_shape(1e-3, -7, 0, 1e3, 1e-6, 0.1)};
    for (int i = 0; i < 3; i++) {
        for (int32_t v = 0; v < meshes[i].vertex_count; v++)
            for (int k = 0; k < 3; k++) meshes[i].vertex[v][k] = (float)meshes[i].vertex[v][k];
        for (int format = JALI_FORMAT_3MF; format <= JALI_FORMAT_STL; format++) {
            jali_bytes bytes = {0};
            CHECK_OK(jali_write_bytes(ctx, format, &(jali_product){.mesh = &meshes[i]}, NULL, &bytes));
            CHECK_OK(jali_check_readback(ctx, bytes.data, bytes.size, &meshes[i]));
            meshes[i].vertex[2][1] += 1e-3 + fabs(meshes[i].vertex[2][1]) * 1e-6;
            CHECK_STATUS(jali_check_readback(ctx, bytes.data, bytes.size, &meshes[i]), JALI_BROKEN);
            meshes[i].vertex[2][1] -= 1e-3 + fabs(meshes[i].vertex[2][1]) * 1e-6;
            jali_bytes_free(ctx, &bytes);
            for (int k = 0; k < 3; k++) meshes[i].vertex[2][k] = (float)meshes[i].vertex[2][k];
        }
        jali_mesh_free(ctx, &meshes[i]);
    }
}

TEST(vertices_that_float32_cannot_tell_apart_are_noticed)
{
    jali_mesh thin = box_shape(1, 1, 1, 1 + 1e-12, 2, 2);
    jali_bytes bytes = {0};
    CHECK_OK(jali_write_stl(ctx, &thin, &bytes));
    CHECK_STATUS(jali_check_readback(ctx, bytes.data, bytes.size, &thin), JALI_BROKEN);
    jali_bytes_free(ctx, &bytes);
    jali_mesh_free(ctx, &thin);
}

TEST(threads_do_not_change_a_byte)
{
    jali_mesh mesh = pierced_plate(61, 1, 3);
    jali_bytes reference[2] = {{0}, {0}};
    jali_write_options opt = {.title = "Jali & <screen> \"x\" \xc3\xa9 \xff \x01",
                              .parameters = "width_mm=61"};
    for (int32_t threads = 1; threads <= 3; threads++) {
        jali_context_options options = jali_context_defaults();
        options.threads = threads;
        jali_context *other;
        CHECK_INT(jali_context_create(&options, &other), JALI_OK);
        for (int i = 0; i < 2; i++) {
            jali_bytes bytes = {0};
            jali_format format = i ? JALI_FORMAT_STL : JALI_FORMAT_3MF;
            CHECK_INT(jali_write_bytes(other, format, &(jali_product){.mesh = &mesh}, &opt, &bytes), JALI_OK);
            if (threads == 1) CHECK_OK(bytes_append(ctx, &reference[i], bytes.data, bytes.size));
            CHECK(same_bytes(&bytes, &reference[i]));
            jali_bytes_free(other, &bytes);
        }
        jali_context_free(other);
    }
    for (int i = 0; i < 2; i++) jali_bytes_free(ctx, &reference[i]);
    jali_mesh_free(ctx, &mesh);
}

TEST(outside_programs_read_the_files)
{
    jali_mesh mesh = pierced_plate(5, 2, 3);
    jali_contours contours = ring();
    jali_product product = {.mesh = &mesh, .contours = &contours, .width_mm = 80, .height_mm = 40};
    jali_write_options opt = {.title = "Jali & <screen> \xff \x01", .parameters = "a=b"};
    int skipped = 0;
    CHECK_OK(jali_write(ctx, in_folder("a.3MF"), &product, &opt));
    CHECK_OK(jali_write(ctx, in_folder("a.stl"), &product, &opt));
    CHECK_OK(jali_write(ctx, in_folder("a.svg"), &product, &opt));
    CHECK_OK(jali_write(ctx, in_folder("a.dxf"), &product, &opt));
    CHECK_INT(files_in_folder(), 4);
    if (succeeds("command -v %s >/dev/null", "unzip")) {
        CHECK(succeeds("unzip -tqq %s", in_folder("a.3MF")));
        if (succeeds("command -v %s >/dev/null", "xmllint"))
            CHECK(succeeds("unzip -p %s 3D/3dmodel.model | xmllint --noout -", in_folder("a.3MF")));
    } else
        skipped++;
    if (succeeds("command -v %s >/dev/null", "xmllint"))
        CHECK(succeeds("xmllint --noout %s", in_folder("a.svg")));
    else
        skipped++;
    if (succeeds("command -v %s >/dev/null", "admesh"))
        CHECK(succeeds("admesh %s | grep -q 'Number of parts *: *1 '", in_folder("a.stl")));
    else
        skipped++;
    if (skipped) print_message("%d outside programs not there: skipped\n", skipped);
    free_ring(&contours);
    jali_mesh_free(ctx, &mesh);
}

TEST(flat_formats_say_what_they_should)
{
    jali_contours contours = ring();
    jali_bytes bytes = {0};
    CHECK_OK(jali_write_svg(ctx, &contours, 80, 40, NULL, &bytes));
    CHECK_OK(bytes_append(ctx, &bytes, "", 1));
    CHECK(strstr((char *)bytes.data, "width=\"80mm\" height=\"40mm\" viewBox=\"0 0 81920 40960\"") != NULL);
    CHECK(strstr((char *)bytes.data, "M 0 40960l 81920 0 0-40960-81920 0z\n") != NULL ||
          strstr((char *)bytes.data, "M 0 40960l 81920 0 0-40960 -81920 0z\n") != NULL);
    jali_bytes_free(ctx, &bytes);
    CHECK_OK(jali_write_dxf(ctx, &contours, &bytes));
    CHECK_OK(bytes_append(ctx, &bytes, "", 1));
    CHECK(strstr((char *)bytes.data, "0\nPOLYLINE\n8\nOUTLINE\n") != NULL);
    CHECK(strstr((char *)bytes.data, "0\nPOLYLINE\n8\nHOLES\n") != NULL);
    CHECK(strstr((char *)bytes.data, "10\n1\n20\n1.9990234\n") != NULL);
    jali_bytes_free(ctx, &bytes);
    free_ring(&contours);
}

typedef struct memory {
    const jali_bytes *bytes;
    size_t at;
} memory;

static void read_memory(png_structp png, png_bytep to, size_t size)
{
    memory *m = png_get_io_ptr(png);
    CHECK(m->at + size <= m->bytes->size);
    memcpy(to, m->bytes->data + m->at, size);
    m->at += size;
}

TEST(a_png_holds_the_bitmap)
{
    uint64_t seed = 3;
    for (int32_t width = 1; width < 200; width += 37) {
        jali_bitmap bitmap = random_bitmap(&seed, width, 21, 40);
        jali_bytes bytes = {0};
        CHECK_OK(jali_bitmap_png(ctx, &bitmap, 0.1, &bytes));
        memory from = {&bytes, 0};
        png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
        png_infop info = png_create_info_struct(png);
        png_set_read_fn(png, &from, read_memory);
        png_read_info(png, info);
        CHECK_INT(png_get_image_width(png, info), width);
        CHECK_INT(png_get_bit_depth(png, info), 1);
        CHECK_INT(png_get_x_pixels_per_meter(png, info), 10000);
        png_set_packing(png);
        for (int32_t y = 0; y < 21; y++) {
            uint8_t row[200];
            png_read_row(png, row, NULL);
            for (int32_t x = 0; x < width; x++) CHECK_INT(row[x], jali_bitmap_get(&bitmap, x, y));
        }
        png_destroy_read_struct(&png, &info, NULL);
        jali_bytes_free(ctx, &bytes);
        jali_bitmap_free(ctx, &bitmap);
    }
}

TEST(a_failed_write_leaves_the_earlier_file)
{
    const char *path = in_folder("kept.stl");
    CHECK_OK(file_write(ctx, path, "old", 3));
    output_file file;
    CHECK_OK(output_open(ctx, path, &file));
    CHECK_OK(output_write(ctx, &file, "new", 3));
    CHECK_INT(files_in_folder(), 2);
    jali_cancel(ctx);
    CHECK_STATUS(output_write(ctx, &file, "more", 4), JALI_CANCELLED);
    output_abandon(ctx, &file);
    output_abandon(ctx, &file);
    CHECK_INT(files_in_folder(), 1);
    CHECK(succeeds("test \"$(cat %s)\" = old", path));
}

TEST(an_unwritable_place_is_a_sentence)
{
    jali_mesh cube = box_shape(0, 0, 0, 1, 1, 1);
    jali_product product = {.mesh = &cube};
    CHECK_STATUS(jali_write(ctx, in_folder("no/such/a.stl"), &product, NULL), JALI_IO);
    CHECK(strstr(jali_message(ctx), "no/such/a.stl: No such file or directory") != NULL);
    CHECK_STATUS(jali_write(ctx, folder, &product, &(jali_write_options){.format = JALI_FORMAT_STL}),
                 JALI_IO);
    CHECK(strstr(jali_message(ctx), "Is a directory") != NULL);
    CHECK_STATUS(jali_write(ctx, "/dev/full", &product, &(jali_write_options){.format = JALI_FORMAT_STL}),
                 JALI_IO);
    CHECK(strstr(jali_message(ctx), "/dev/full: No space left on device") != NULL);
    CHECK_OK(jali_write(ctx, "/dev/null", &product, &(jali_write_options){.format = JALI_FORMAT_STL}));
    CHECK_STATUS(jali_write(ctx, in_folder("a.xyz"), &product, NULL), JALI_BAD_VALUE);
    CHECK_STATUS(jali_write(ctx, in_folder("a.svg"), &product, NULL), JALI_BAD_VALUE);
    CHECK(strstr(jali_message(ctx), "SVG needs flat contours") != NULL);
    CHECK_INT(files_in_folder(), 0);
    jali_mesh_free(ctx, &cube);
}

// A limit on the size of files stands in for a full disk: the temporary cannot grow, the earlier file must
// stay.
TEST(a_full_disk_leaves_the_earlier_file)
{
    const char *path = in_folder("kept.stl");
    CHECK_OK(file_write(ctx, path, "old", 3));
    jali_mesh mesh = pierced_plate(61, 1, 3);
    struct rlimit before, small = {1 << 16, RLIM_INFINITY};
    CHECK_INT(getrlimit(RLIMIT_FSIZE, &before), 0);
    small.rlim_max = before.rlim_max;
    signal(SIGXFSZ, SIG_IGN);
    CHECK_INT(setrlimit(RLIMIT_FSIZE, &small), 0);
    jali_status status = jali_write(ctx, path, &(jali_product){.mesh = &mesh}, NULL);
    CHECK_INT(setrlimit(RLIMIT_FSIZE, &before), 0);
    CHECK_INT(status, JALI_IO);
    CHECK(strstr(jali_message(ctx), "kept.stl: File too large") != NULL);
    CHECK(succeeds("test \"$(cat %s)\" = old", path));
    CHECK_INT(files_in_folder(), 1);
    jali_mesh_free(ctx, &mesh);
}

TEST(modes_and_links_outlive_a_write)
{
    struct stat after;
    CHECK_OK(file_write(ctx, in_folder("real"), "old", 3));
    CHECK_INT(chmod(in_folder("real"), 0640), 0);
    CHECK_INT(symlink("real", in_folder("link")), 0);
    CHECK_OK(file_write(ctx, in_folder("link"), "newer", 5));
    CHECK_INT(lstat(in_folder("link"), &after), 0);
    CHECK(S_ISLNK(after.st_mode));
    CHECK_INT(stat(in_folder("real"), &after), 0);
    CHECK_INT(after.st_mode & 0777, 0640);
    CHECK_INT(after.st_size, 5);
    CHECK_OK(file_write(ctx, in_folder("fresh"), "", 0));
    CHECK_INT(stat(in_folder("fresh"), &after), 0);
    mode_t mask = umask(0);
    umask(mask);
    CHECK_INT(after.st_mode & 0777, 0666 & ~mask);
    CHECK_INT(files_in_folder(), 3);
}

TEST(a_file_over_the_limit_is_refused)
{
    jali_bytes bytes;
    CHECK_OK(file_write(ctx, in_folder("ten"), "0123456789", 10));
    CHECK_STATUS(file_read(ctx, in_folder("ten"), 9, &bytes), JALI_LIMIT);
    CHECK(bytes.data == NULL);
    CHECK_OK(file_read(ctx, in_folder("ten"), 10, &bytes));
    CHECK(bytes.size == 10 && bytes.data[10] == 0);
    jali_bytes_free(ctx, &bytes);
}

typedef struct everything {
    jali_mesh mesh;
    jali_contours contours;
    jali_bitmap bitmap;
} everything;

static jali_status write_everything(jali_context *limited, void *data)
{
    jali_status status = JALI_OK;
    everything *all = data;
    jali_product product = {.mesh = &all->mesh, .contours = &all->contours, .bitmap = &all->bitmap};
    for (int format = JALI_FORMAT_3MF; format <= JALI_FORMAT_PNG && status == JALI_OK; format++) {
        jali_write_options opt = {.format = format, .title = "title", .parameters = "parameters"};
        status = jali_write(limited, in_folder("all"), &product, &opt);
    }
    return status;
}

TEST(every_refused_allocation_is_a_status)
{
    uint64_t seed = 1;
    everything all = {pierced_plate(3, 1, 0), ring(), random_bitmap(&seed, 50, 50, 50)};
    refuse_each_allocation(write_everything, &all);
    CHECK_INT(files_in_folder(), 1);
    jali_mesh_free(ctx, &all.mesh);
    free_ring(&all.contours);
    jali_bitmap_free(ctx, &all.bitmap);
}

#define RUN(test) cmocka_unit_test_setup_teardown(test, open_folder, close_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        RUN(decimals_read_back_the_same),
        RUN(models_read_back_the_same),
        RUN(vertices_that_float32_cannot_tell_apart_are_noticed),
        RUN(threads_do_not_change_a_byte),
        RUN(outside_programs_read_the_files),
        RUN(flat_formats_say_what_they_should),
        RUN(a_png_holds_the_bitmap),
        RUN(a_failed_write_leaves_the_earlier_file),
        RUN(an_unwritable_place_is_a_sentence),
        RUN(a_full_disk_leaves_the_earlier_file),
        RUN(modes_and_links_outlive_a_write),
        RUN(a_file_over_the_limit_is_refused),
        RUN(every_refused_allocation_is_a_status),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
