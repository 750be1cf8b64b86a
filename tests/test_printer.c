// Printer profiles: what is read, what is refused and why, what is inherited, what is built in.
#include "testing.h"
#include "base/bytes.h"
#include "base/file.h"
#include "printer/figures.h"

#include <jali/printer.h>
#include <jansson.h>
#include <math.h>
#include <unistd.h>

static jali_status read_text(jali_context *c, const char *json, const char *name, const char *folder,
                             jali_printer *printer)
{
    return jali_printer_read(c, (const uint8_t *)json, strlen(json), name, folder, printer);
}

#define NEEDED                                                                                               \
    "\"phi_e_solid_mm\": 0.12, \"phi_e_void_mm\": {\"value\": 0.2, \"source\": \"a rule\"}, \"phi_s_mm\": "  \
    "0.4, "                                                                                                  \
    "\"phi_v_mm\": 0.5"

// Refused, with these words in the sentence.
static void refused(const char *json, const char *words)
{
    jali_printer p;
    jali_status status = read_text(ctx, json, "mine.json", NULL, &p);
    if (status == JALI_OK || !strstr(jali_message(ctx), words))
        print_error("%s: status %d: %s\n", json, status, jali_message(ctx));
    CHECK_INT(status, JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), words));
    CHECK(p.name[0] == 0 && p.phi_s_mm.value == 0);
}

TEST(a_profile_is_read)
{
    jali_printer p;
    CHECK_OK(read_text(
        ctx,
        "{\"jali_printer\": 1, \"name\": \"mine\", \"process\": \"sla\", " NEEDED
        ", \"bed_mm\": {\"value\": [100, 60.5, 150], \"source\": \"its manual\"}, \"material\": \"resin\"}",
        "x/mine.json", NULL, &p));
    CHECK(strcmp(p.name, "mine") == 0 && p.process == JALI_PROCESS_SLA);
    CHECK(p.phi_e_solid_mm.value == 0.12 && p.phi_e_void_mm.value == 0.2);
    CHECK(strcmp(p.phi_e_void_mm.source, "a rule") == 0);
    CHECK(strstr(p.phi_s_mm.source, "without a source"));
    CHECK(p.bed_mm[1].value == 60.5 && strcmp(p.bed_mm[2].source, "its manual") == 0);
    CHECK(jali_printer_phi_e_mm(&p) == (0.12 + 0.2) / 2);
    CHECK(!*p.tool_mm.source && !*p.hole_mm2.source);
    jali_material m;
    CHECK(jali_printer_material(&p, &m));
    CHECK(strcmp(m.name, "resin") == 0 && m.e_mpa == jali_material_find("resin")->e_mpa);
}

TEST(a_material_of_its_own)
{
    jali_printer p;
    jali_material m;
    CHECK_OK(read_text(
        ctx,
        "{\"jali_printer\": 1, " NEEDED ", \"material\": {\"name\": \"bone\", \"e_mpa\": 18000, "
        "\"nu\": 0.3, \"density_g_cm3\": 1.9, \"limit_mpa\": {\"value\": 20, \"source\": \"a vet\"}}}",
        "folder/my.own.json", NULL, &p));
    CHECK(strcmp(p.name, "my.own") == 0); // after its file
    CHECK(jali_printer_material(&p, &m));
    CHECK(strcmp(m.name, "bone") == 0 && m.e_mpa == 18000 && strcmp(m.source, "a vet") == 0);
}

TEST(what_is_wrong_is_said)
{
    refused("", "no printer profile");
    refused("[1, 2]", "\"jali_printer\": 1");
    refused("{\"jali_printer\": 1, \"jali_printer\": 1}", "no printer profile");
    refused("{\"jali_printer\": 2}", "1 is accepted");
    refused("{\"jali_printer\": 1, \"phi_s_mm\": 1}", "does not say \"phi_e_solid_mm\"");
    refused("{\"jali_printer\": 1, " NEEDED ", \"nozzle\": 0.4}", "has a \"nozzle\"; the keys are name");
    refused("{\"jali_printer\": 1, \"phi_s_mm\": -1}", "\"phi_s_mm\" takes a number, 0.001 to 100 mm");
    refused("{\"jali_printer\": 1, \"phi_s_mm\": \"1\"}", "\"phi_s_mm\" takes a number");
    refused("{\"jali_printer\": 1, \"phi_s_mm\": {\"value\": 1, \"from\": 2}}", "has a \"from\"");
    refused("{\"jali_printer\": 1, \"phi_s_mm\": {\"value\": 1, \"source\": 7}}", "takes a text");
    refused("{\"jali_printer\": 1, \"process\": \"milling\"}", "not milling");
    refused("{\"jali_printer\": 1, \"bed_mm\": [1, 2]}", "three lengths");
    refused("{\"jali_printer\": 1, \"name\": "
            "\"0123456789012345678901234567890123456789012345678901234567890123\"}",
            "64 bytes; up to 63");
    refused("{\"jali_printer\": 1, " NEEDED ", \"material\": \"cheese\"}", "no material \"cheese\"");
    refused("{\"jali_printer\": 1, " NEEDED ", \"material\": {\"name\": \"a\", \"e_mpa\": 1}}",
            "needs \"e_mpa\"");
    refused("{\"jali_printer\": 1, " NEEDED ", \"material\": {\"name\": \"a\", \"colour\": 1}}",
            "has a \"colour\"");
    refused("{\"jali_printer\": 1, \"phi_e_solid_mm\": -0.4, \"phi_e_void_mm\": 0, \"phi_s_mm\": 0.4, "
            "\"phi_v_mm\": 1}",
            "would come out 0 mm wide");
    refused("{\"jali_printer\": 1, \"phi_e_solid_mm\": 0, \"phi_e_void_mm\": 2, \"phi_s_mm\": 0.4, "
            "\"phi_v_mm\": 1}",
            "a void of");
    refused("{\"jali_printer\": 1, \"inherits\": 3}", "\"inherits\" takes");
}

static char folder[] = "/tmp/jali-printers-XXXXXX";

static void put(const char *name, const char *text)
{
    char path[100];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    CHECK_OK(file_write(ctx, path, text, strlen(text)));
}

TEST(profiles_inherit)
{
    jali_printer p;
    put("base.json", "{\"jali_printer\": 1, \"what\": \"a base\", " NEEDED "}");
    put("mine.json", "{\"jali_printer\": 1, \"inherits\": \"base.json\", \"phi_s_mm\": 0.7}");
    put("fine.json",
        "{\"jali_printer\": 1, \"name\": \"fine one\", \"inherits\": \"mine\", \"phi_v_mm\": 0.9}");
    put("paper.json", "{\"jali_printer\": 1, \"inherits\": \"hori-z500\", \"corner_mm\": 0.2}");
    CHECK_OK(jali_printer_find(ctx, "fine", folder, &p));
    CHECK(p.phi_s_mm.value == 0.7 && p.phi_v_mm.value == 0.9 && p.phi_e_void_mm.value == 0.2);
    CHECK(strcmp(p.name, "fine one") == 0 && !*p.what);
    CHECK_OK(jali_printer_find(ctx, "mine", folder, &p));
    CHECK(strcmp(p.name, "mine") == 0);
    CHECK_OK(jali_printer_find(ctx, "paper", folder, &p));
    CHECK(p.phi_s_mm.value == 0.3 && p.corner_mm.value == 0.2 && p.process == JALI_PROCESS_FDM);
}

TEST(circles_and_long_chains_end)
{
    jali_printer p;
    char name[20], text[100];
    put("a.json", "{\"jali_printer\": 1, \"inherits\": \"b\"}");
    put("b.json", "{\"jali_printer\": 1, \"inherits\": \"a\"}");
    CHECK_STATUS(jali_printer_find(ctx, "a", folder, &p), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "inherits itself"));
    for (int32_t i = 0; i < 9; i++) {
        snprintf(name, sizeof name, "link%d.json", i);
        snprintf(text, sizeof text, "{\"jali_printer\": 1, \"inherits\": \"%s%d\"}",
                 i < 8 ? "link" : "lite600", i + 1);
        put(name, text);
    }
    CHECK_STATUS(jali_printer_find(ctx, "link0", folder, &p), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "8 are accepted"));
}

TEST(unknown_names_get_the_nearest)
{
    jali_printer p;
    CHECK_STATUS(jali_printer_find(ctx, "hori-z50", NULL, &p), JALI_BAD_VALUE);
    CHECK(strstr(jali_message(ctx), "did you mean hori-z500?"));
    CHECK_STATUS(jali_printer_find(ctx, "a printing press", NULL, &p), JALI_BAD_VALUE);
    CHECK_STATUS(jali_printer_find(ctx, "./nowhere.json", NULL, &p), JALI_IO);
}

// Every profile that is built in reads, says what it is, names a source for each figure, and writes to bytes
// that read back as the same profile.
TEST(built_in_profiles_are_whole)
{
    int32_t count;
    const char *const *name = jali_printer_names(&count);
    CHECK(count >= 3);
    for (int32_t i = 0; i < count; i++) {
        jali_printer p, again;
        jali_bytes json = {0}, twice = {0};
        if (i > 0) CHECK(strcmp(name[i - 1], name[i]) < 0);
        CHECK_OK(jali_printer_find(ctx, name[i], NULL, &p));
        CHECK(strcmp(p.name, name[i]) == 0 && *p.what && p.process != JALI_PROCESS_NONE);
        CHECK_OK(jali_printer_write(ctx, &p, &json));
        if (strstr((const char *)json.data, "without a source")) print_error("%s has no source\n", name[i]);
        CHECK(!strstr((const char *)json.data, "without a source"));
        CHECK_OK(jali_printer_read(ctx, json.data, json.size, "again", NULL, &again));
        CHECK(memcmp(&p, &again, sizeof p) == 0);
        CHECK_OK(jali_printer_write(ctx, &again, &twice));
        CHECK(json.size == twice.size && memcmp(json.data, twice.data, json.size) == 0);
        jali_bytes_free(ctx, &json);
        jali_bytes_free(ctx, &twice);
    }
}

// The schema for editors accepts the keys that the reader takes, in the same ranges, and no other.
TEST(the_schema_says_what_the_reader_takes)
{
    int32_t counts[2];
    const figure_key *keys[2] = {figure_keys(&counts[0]), material_keys(&counts[1])};
    json_error_t error;
    if (!getenv("JALI_SCHEMA")) return; // not started by ctest
    json_t *schema = json_load_file(getenv("JALI_SCHEMA"), 0, &error);
    json_t *properties[2] = {json_object_get(schema, "properties"), NULL};
    json_t *of_material = json_object_get(properties[0], "material");
    properties[1] = json_object_get(json_array_get(json_object_get(of_material, "oneOf"), 1), "properties");
    CHECK_INT(json_object_size(properties[0]), (size_t)counts[0] + 7); // kind, name, what, inherits, ...
    CHECK_INT(json_object_size(properties[1]), (size_t)counts[1] + 1); // name
    for (int32_t list = 0; list < 2; list++)
        for (int32_t i = 0; i < counts[list]; i++) {
            const figure_key *k = &keys[list][i];
            json_t *number =
                json_array_get(json_object_get(json_object_get(properties[list], k->key), "oneOf"), 0);
            CHECK(json_number_value(json_object_get(number, "minimum")) == k->least);
            CHECK(json_number_value(json_object_get(number, "maximum")) == k->most);
        }
    json_decref(schema);
}

TEST(the_papers_printers)
{
    static const struct {
        const char *name;
        double phi[3];
    } paper[] = {{"hori-z500", {.1, .3, .5}}, {"lite600", {.1, .25, .45}}, {"form1+", {.1, .3, .5}}};
    for (int32_t i = 0; i < 3; i++) {
        jali_printer p;
        CHECK_OK(jali_printer_find(ctx, paper[i].name, NULL, &p));
        CHECK(jali_printer_phi_e_mm(&p) == paper[i].phi[0] && p.phi_s_mm.value == paper[i].phi[1] &&
              p.phi_v_mm.value == paper[i].phi[2]);
    }
}

// Its own figures, and the rest of the built-in one with the nearest nozzle.
TEST(a_prusaslicer_configuration)
{
    jali_printer p, base;
    CHECK_OK(read_text(ctx,
                       "# generated by PrusaSlicer 2.5.0\nbed_shape = 0x0,250x0,250x210,0x210\n"
                       "external_perimeter_extrusion_width = 0.45\nfilament_type = PETG;PLA\r\n"
                       "layer_height = 0.15\nmax_print_height = 200\nmin_bead_width = 85%\n"
                       "nozzle_diameter = 0.4,0.4\nperimeter_generator = arachne\nprinter_technology = FFF\n"
                       "start_gcode = G28 ; home\nnotes = a = b",
                       "in/my.ini", NULL, &p));
    CHECK_OK(jali_printer_find(ctx, "fdm-0.4", NULL, &base));
    CHECK(strcmp(p.name, "my") == 0 && p.process == JALI_PROCESS_FDM && strcmp(p.material, "petg") == 0);
    CHECK(p.tool_mm.value == 0.4 && p.layer_mm.value == 0.15);
    CHECK(fabs(p.phi_s_mm.value - 0.34) < 1e-12 && strstr(p.phi_s_mm.source, "my.ini: min_bead_width"));
    CHECK(p.bed_mm[0].value == 250 && p.bed_mm[1].value == 210 && p.bed_mm[2].value == 200);
    CHECK(memcmp(&p.phi_e_void_mm, &base.phi_e_void_mm, sizeof p.phi_e_void_mm) == 0);
    CHECK(strstr(p.what, "PrusaSlicer") && strstr(p.what, "those of fdm-0.4"));
    // As it stands at the end of G-code; classic walls, widths in percent of the layer's height.
    CHECK_OK(read_text(ctx,
                       "G1 X10 E5\n; layer_height = 0.3\n; nozzle_diameter = 0.6\n"
                       "; external_perimeter_extrusion_width = 200%\n; perimeter_generator = classic\n",
                       "in/print.gcode", NULL, &p));
    CHECK(p.tool_mm.value == 0.6 && fabs(p.phi_s_mm.value - 1.2) < 1e-12 &&
          strstr(p.phi_s_mm.source, "two outer lines"));
    CHECK_OK(read_text(ctx, "thin_walls = 1\nnozzle_diameter = 0.25", "x.ini", NULL, &p));
    CHECK(p.phi_s_mm.value == 0.25 && p.phi_e_solid_mm.value == 0.125);
    CHECK_OK(read_text(ctx, "nozzle_diameter = 0.8\nextrusion_width = 0", "x.ini", NULL, &p));
    CHECK(fabs(p.phi_s_mm.value - 2 * 1.125 * 0.8) < 1e-12);
}

TEST(a_prusaslicer_configuration_of_a_resin_printer)
{
    jali_printer p;
    CHECK_OK(read_text(
        ctx,
        "printer_technology = SLA\ndisplay_width = 120\ndisplay_height = 68\ndisplay_pixels_x = 2560\n"
        "display_pixels_y = 1440\nbed_shape = 0x0,120x0,120x68,0x68\nmax_print_height = 200\n"
        "layer_height = 0.05\nprinter_settings_id = Original Prusa SL1\n",
        "sl1.ini", NULL, &p));
    CHECK(p.process == JALI_PROCESS_SLA && p.tool_mm.value == 120.0 / 2560 && p.bed_mm[1].value == 68);
    CHECK(strcmp(p.name, "Original Prusa SL1") == 0 && strcmp(p.material, "resin") == 0);
}

// Values are texts or lists of texts; what it inherits is in a file that we do not have.
TEST(an_orca_profile)
{
    jali_printer p;
    CHECK_OK(read_text(
        ctx,
        "{\"type\": \"machine\", \"from\": \"User\", \"name\": \"My A1\", \"inherits\": \"Bambu Lab A1 0.6 "
        "nozzle\", \"nozzle_diameter\": [\"0.6\"], \"printable_area\": [\"0x0\", \"256x0\", \"256x256\", "
        "\"0x256\"], \"printable_height\": \"250\", \"wall_generator\": \"arachne\"}",
        "a1.json", NULL, &p));
    CHECK(strcmp(p.name, "My A1") == 0 && p.tool_mm.value == 0.6 && fabs(p.phi_s_mm.value - 0.51) < 1e-12);
    CHECK(p.bed_mm[0].value == 256 && p.bed_mm[2].value == 250);
    CHECK(strstr(p.what, "\"Bambu Lab A1 0.6 nozzle\", which is not at hand"));
    // A process alone: widths in percent of the nozzle need the nozzle; a width tells which it is.
    CHECK_OK(read_text(
        ctx, "{\"type\": \"process\", \"layer_height\": \"0.2\", \"outer_wall_line_width\": \"0.42\"}",
        "fine.json", NULL, &p));
    CHECK(p.layer_mm.value == 0.2 && fabs(p.phi_s_mm.value - 0.84) < 1e-12 &&
          strstr(p.tool_mm.source, "assumed from"));
    CHECK_OK(read_text(ctx, "{\"filament_type\": [\"ABS\"]}", "abs.json", NULL, &p));
    CHECK(strcmp(p.material, "abs") == 0 && p.phi_s_mm.value == 0.8 && strstr(p.tool_mm.source, "assumed:"));
}

TEST(what_is_wrong_with_a_slicers_profile_is_said)
{
    refused("nozzle_diameter = wide", "\"nozzle_diameter\" is \"wide\"; a number is accepted");
    refused("nozzle_diameter = 0.4mm", "a number is accepted");
    refused("nozzle_diameter = 4000", "\"tool_mm\" takes a number");
    refused("bed_shape = 0x0,250\nmax_print_height = 3", "points such as");
    refused("[printer:MK4]\nnozzle_diameter = 0.4", "a bundle of several profiles");
    refused("a = b\nc = d", "no printer profile");
    refused("{\"a\": 1}", "no printer profile");
    refused("{\"nozzle_diameter\": [\"x\"]}", "a number is accepted");
}

TEST(every_number_reads_back_as_itself)
{
    static const double number[] = {0.1, 0.5, 135.0 / 5120, 1.0 / 3, 0.1f, 1e-3, 99.99999999999999};
    for (size_t i = 0; i < sizeof number / sizeof *number; i++) {
        jali_printer p, again;
        jali_bytes json = {0};
        CHECK_OK(jali_printer_find(ctx, "lite600", NULL, &p));
        p.phi_s_mm.value = number[i];
        CHECK_OK(jali_printer_write(ctx, &p, &json));
        CHECK_OK(jali_printer_read(ctx, json.data, json.size, "again", NULL, &again));
        CHECK(again.phi_s_mm.value == number[i]);
        jali_bytes_free(ctx, &json);
    }
}

TEST(a_profile_that_could_not_be_read_is_not_written)
{
    jali_printer p;
    jali_bytes json = {0};
    CHECK_OK(jali_printer_find(ctx, "lite600", NULL, &p));
    p.phi_s_mm.value = -1;
    CHECK_STATUS(jali_printer_write(ctx, &p, &json), JALI_BAD_VALUE);
    CHECK_INT(json.size, 0);
    p = (jali_printer){0};
    CHECK_STATUS(jali_printer_write(ctx, &p, &json), JALI_BAD_VALUE);
    CHECK_INT(json.size, 0);
    jali_bytes_free(ctx, &json);
}

static jali_status read_and_write(jali_context *limited, void *data)
{
    jali_printer p;
    jali_bytes json = {0};
    jali_status status = jali_printer_find(limited, data, folder, &p);
    if (status == JALI_OK) status = jali_printer_write(limited, &p, &json);
    jali_bytes_free(limited, &json);
    return status;
}

TEST(every_allocation_refused_once)
{
    static char ours[] = "fine", orca[100];
    refuse_each_allocation(read_and_write, ours);
    put("orca.json", "{\"nozzle_diameter\": [\"0.4\", \"0.4\"], \"printable_area\": [\"0x0\", \"9x9\"]}");
    snprintf(orca, sizeof orca, "%s/orca.json", folder);
    refuse_each_allocation(read_and_write, orca);
}

static int make_folder(void **state)
{
    return mkdtemp(folder) ? open_context(state) : -1;
}

static int remove_folder(void **state)
{
    char command[100];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command) == 0 ? close_context(state) : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_profile_is_read),
        cmocka_unit_test(a_material_of_its_own),
        cmocka_unit_test(what_is_wrong_is_said),
        cmocka_unit_test(profiles_inherit),
        cmocka_unit_test(circles_and_long_chains_end),
        cmocka_unit_test(unknown_names_get_the_nearest),
        cmocka_unit_test(built_in_profiles_are_whole),
        cmocka_unit_test(the_schema_says_what_the_reader_takes),
        cmocka_unit_test(the_papers_printers),
        cmocka_unit_test(a_prusaslicer_configuration),
        cmocka_unit_test(a_prusaslicer_configuration_of_a_resin_printer),
        cmocka_unit_test(an_orca_profile),
        cmocka_unit_test(what_is_wrong_with_a_slicers_profile_is_said),
        cmocka_unit_test(every_number_reads_back_as_itself),
        cmocka_unit_test(a_profile_that_could_not_be_read_is_not_written),
        cmocka_unit_test(every_allocation_refused_once),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
