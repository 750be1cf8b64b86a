// The program itself: exit codes and sentences for each kind of bad input; earlier output stays untouched.
#include "testing.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { TEXT_BYTES = 8192 };

static char folder[] = "/tmp/jali-test-XXXXXX";
static char said[TEXT_BYTES];    // stderr of the last run
static char printed[TEXT_BYTES]; // its stdout

static void read_text(const char *name, char text[TEXT_BYTES])
{
    FILE *file = fopen(name, "rb");
    size_t size = file ? fread(text, 1, TEXT_BYTES - 1, file) : 0;
    text[size] = 0;
    if (file) fclose(file);
}

static pid_t start(const char *arguments)
{
    char command[2 * TEXT_BYTES];
    const char *program = getenv("JALI_PROGRAM");
    snprintf(command, sizeof command, "exec %s %s >stdout.txt 2>stderr.txt", program, arguments);
    pid_t child = fork();
    if (child == 0) {
        execl("/bin/sh", "sh", "-c", command, (char *)NULL);
        _exit(127);
    }
    return child;
}

static int finish(pid_t child)
{
    int state;
    CHECK_INT(waitpid(child, &state, 0), child);
    read_text("stderr.txt", said);
    read_text("stdout.txt", printed);
    return WIFEXITED(state) ? WEXITSTATUS(state) : 1000 + WTERMSIG(state);
}

// Run; its sentence must hold `words`, and a failure says exactly one line.
static void run(const char *arguments, int wanted, const char *words)
{
    int code = finish(start(arguments));
    int32_t lines = 0;
    for (const char *c = said; *c; c++) lines += *c == '\n';
    bool one_line = wanted == 0 || lines == 1;
    if (code != wanted || !strstr(said, words) || !one_line)
        print_error("jali %s: exit %d (wanted %d): %s", arguments, code, wanted, said);
    CHECK_INT(code, wanted);
    CHECK(strstr(said, words) && one_line);
}

static void write_text(const char *name, const char *text, size_t size)
{
    FILE *file = fopen(name, "wb");
    CHECK(file && fwrite(text, 1, size, file) == size && fclose(file) == 0);
}

static int open_folder(void **state)
{
    (void)state;
    if (!getenv("JALI_PROGRAM") || !*getenv("JALI_PROGRAM")) return -1;
    if (!mkdtemp(folder) || chdir(folder) != 0) return -1;
    write_text("two.pbm", "P1 4 3 0000 0110 0000", 21);
    return 0;
}

static int close_folder(void **state)
{
    char command[64];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

TEST(help_version_and_lists_go_to_stdout)
{
    run("--help", 0, "");
    CHECK(strstr(printed, "jali sample NAME"));
    run("--version", 0, "");
    CHECK(strncmp(printed, "jali ", 5) == 0);
    run("sample --help", 0, "");
    CHECK(strstr(printed, "--size PX") && !strstr(printed, "--width"));
    run("list samples", 0, "");
    CHECK(strstr(printed, "girih") && *said == 0);
}

TEST(usage_is_checked_before_anything_is_done)
{
    run("", 2, "what shall be done");
    run("smaple", 2, "did you mean \"jali sample\"");
    run("zzzzzzzz", 2, "\"jali --help\"");
    run("sample girih", 2, "needs an output file");
    run("sample -o a.png", 2, "needs a NAME");
    run("sample girih tree -o a.png", 2, "takes one NAME");
    run("sample girih -o a.jpg", 2, "does not write this type");
    run("sample girih -o a.png -o a.png", 2, "named twice");
    run("sample girih -o a.png --sise 3", 2, "did you mean --size");
    run("sample girih -o a.png --width 3", 2, "not an option of jali sample");
    run("sample girih -o a.png --size", 2, "needs a value (PX)");
    run("sample girih -o a.png --size=", 2, "needs a value (PX)");
    run("sample girih -o a.png --size 100.5", 2, "whole number");
    run("sample girih -o a.png --size 5", 2, "16 .. 32768 px");
    run("sample girih -o a.png --quiet=3", 2, "takes no value");
    run("sample lion -o a.png", 2, "there are girih");
    run("list socks", 2, "samples, surfaces, materials and printers");
    CHECK(access("a.png", F_OK) != 0);
}

TEST(numbers_are_numbers_in_their_range)
{
    run("place two.pbm -o a.png --width nan", 2, "takes a number");
    run("place two.pbm -o a.png --width inf", 2, "takes a number");
    run("place two.pbm -o a.png --width 0", 2, "0.01 .. 10000 mm");
    run("place two.pbm -o a.png --width -5", 2, "0.01 .. 10000 mm");
    run("place two.pbm -o a.png --width 7cm", 2, "a number in mm");
    run("place two.pbm -o a.png --width 1e9", 2, "0.01 .. 10000 mm");
    run("place two.pbm -o a.png --width 40 --height 40", 2, "shape of the picture");
    run("place two.pbm -o a.png --width 40 --phi-v 39", 1, "narrowest feature");
    run("place two.pbm -o a.png --width 9000 --pixel 0.0002", 1, "coarser");
    run("place two.pbm -o a.png --threshold 256", 2, "0 .. 255");
    run("place two.pbm -o a.png --threshold maybe", 2, "takes a number");
    run("place two.pbm -o a.png --crop 0,0,9,9", 2, "does not lie inside");
    run("place two.pbm -o a.png --crop 0,0,4", 2, "left,top,width,height");
    run("place two.pbm -o a.png --rotate 45", 2, "0, 90, 180 or 270");
    CHECK(access("a.png", F_OK) != 0);
}

// A profile sets the three figures; what is given outright counts, wherever it stands.
TEST(a_printer_sets_what_no_option_does)
{
    char words[200], json[TEXT_BYTES];
    setenv("XDG_CONFIG_HOME", folder, 1);
    run("list printers", 0, "");
    CHECK(strstr(printed, "hori-z500") && strstr(printed, "laser-acrylic") &&
          !strstr(printed, "cannot be read"));
    run("adapt two.pbm -o a.png --printer form1", 2, "did you mean form1+?");
    run("adapt two.pbm -o a.png --printer none.json", 1, "none.json");
    write_text("bad.json", "{\"jali_printer\": 1, \"phi_s_mm\": \"thin\"}", 39);
    run("adapt two.pbm -o a.png --printer bad.json", 4, "\"phi_s_mm\" takes a number");
    CHECK(access("a.png", F_OK) != 0);
    const char *own = "{\"jali_printer\": 1, \"inherits\": \"lite600\", \"phi_e_void_mm\": 0.3}";
    CHECK(mkdir("jali", 0700) == 0 && mkdir("jali/printers", 0700) == 0);
    write_text("jali/printers/mine.json", own, strlen(own));
    write_text("jali/printers/broken.json", "{}", 2);
    run("list printers", 0, "");
    CHECK(strstr(printed, "mine             sla     phi   0.2 / 0.25 / 0.45"));
    CHECK(strstr(printed, "broken.json      cannot be read"));
    for (int32_t order = 0; order < 2; order++) {
        snprintf(words, sizeof words,
                 "adapt two.pbm -o a.png --force-overwrite --json f.json %s --phi-v 0.6 %s",
                 order ? "" : "--printer mine", order ? "--printer mine" : "");
        run(words, 0, "");
        read_text("f.json", json);
        CHECK(strstr(json, "\"name\": \"mine\"") && strstr(json, "\"process\": \"sla\""));
        CHECK(strstr(json, "\"phi_e_mm\": 0.2") && strstr(json, "\"phi_s_mm\": 0.25"));
        CHECK(strstr(json, "\"phi_v_mm\": 0.6") && strstr(json, "\"phi_e_void_mm\": 0.3"));
    }
    unlink("a.png");
    run("analyse two.pbm --force 1 --printer mine --json - --width 70", 0, "");
    CHECK(strstr(printed, "\"name\": \"resin\""));
    run("analyse two.pbm --force 1 --material steel --printer mine --json - --width 70", 0, "");
    CHECK(strstr(printed, "\"name\": \"steel\""));
}

TEST(predict_says_what_a_printer_would_make_of_a_picture)
{
    char json[TEXT_BYTES], of_adapt[TEXT_BYTES];
    run("sample rings -o rings.png --size 200", 0, "");
    run("predict rings.png", 0, "would come out wrong");
    run("predict rings.png --printer hori-z500 --width 40 -o map.png --json p.json", 0, "would be there");
    read_text("p.json", json);
    run("adapt rings.png --printer hori-z500 --width 40 -o a.png --json a.json", 0, "");
    read_text("a.json", of_adapt);
    const char *error = strstr(json, "\"error_rate\": "), *input = strstr(of_adapt, "\"error_rate_input\": ");
    CHECK(error && input && strtod(error + 14, NULL) > 0);
    CHECK(strtod(error + 14, NULL) == strtod(input + 20, NULL));
    CHECK(strstr(json, "\"name\": \"hori-z500\"") && access("map.png", F_OK) == 0);
    run("predict rings.png --width 40 -o map.png", 2, "exists");
    run("predict rings.png --printer laser-acrylic --phi-e -1", 0, "would come out wrong");
    run("carve rings.png -o cut.stl --printer laser-acrylic --width 120 --force 1", 0,
        "the kerf leaves them 0.2 mm");
    unlink("cut.stl");
    run("predict rings.png -o map.svg", 2, "does not write this type");
    unlink("map.png");
    unlink("rings.png");
    unlink("a.png");
}

TEST(a_picture_is_read_as_grey_and_cropped_by_its_own_pixels)
{
    write_text("ramp.pgm", "P2 3 2 255 10 20 30 40 50 60", 28);
    run("read ramp.pgm --crop 1,0,2,2 --rotate 90 -o turned.png --json r.json", 0,
        "2 x 2 px; --threshold auto is");
    run("read turned.png --json t.json", 0, "2 x 2 px");
    CHECK_INT(system("cmp r.json t.json"), 0);
    read_text("r.json", printed);
    CHECK(strstr(printed, "\"threshold_auto\": 40") || strstr(printed, "\"threshold_auto\": 41"));
    run("read ramp.pgm --crop 2,0,2,2", 2, "the crop 2,0,2,2 (left, top, width, height) does not lie inside");
    run("read two.pbm --crop 0,0,4,1", 0, "all of one grey level");
    run("read ramp.pgm -o g.stl", 2, "does not write this type");
    run("read ramp.pgm --width 30", 2, "--width is not an option of jali read");
}

TEST(a_profile_is_written_in_full)
{
    run("printer fdm-0.4 -o whole.json", 0, "fdm-0.4: phi 0.2 / 0.8 / 0.6 mm");
    run("printer ./whole.json -o again.json", 0, "");
    CHECK_INT(system("cmp whole.json again.json"), 0);
    run("printer fdm-9 -o no.json", 2, "there is no printer \"fdm-9\"");
    run("printer two.pbm -o no.json", 2, "there is no printer");
    run("printer ./two.pbm -o no.json", 4, "two.pbm");
    CHECK(access("no.json", F_OK) != 0);
}

TEST(the_smallest_size_is_found_or_said_to_be_none)
{
    run("sample rings -o rings.png --size 120", 0, "");
    run("smallest rings.png --json s.json", 0, "nothing is lost from a width of");
    read_text("s.json", printed);
    CHECK(strstr(printed, "\"confirmed_mm\"") && strstr(printed, "\"speck_px\": 8"));
    run("smallest rings.png --most 5 --least 4", 0, "something is lost at every width up to 5 mm");
    run("smallest rings.png --most 5 --least 6", 2, "widths from 6 to 5 mm cannot be tried");
    run("smallest rings.png --speck 0", 2, "--speck must be");
    unlink("rings.png");
}

TEST(a_board_is_made_and_measured)
{
    run("board -o b.3mf -o b.svg --phi-s 0.2 --phi-v 0.3", 0, "135 features");
    run("check b.3mf", 0, "");
    CHECK(strstr(printed, "1 piece") && strstr(printed, "is a solid"));
    run("board --phi-s 1.5 --phi-v 1.5 --within 100 -o c.3mf", 1, "100 mm is the longest side");
    run("board --phi-s 4 -o c.3mf", 2, "0.05 to 3 mm");
    // A picture of the board is a perfect print of it.
    run("board --phi-s 1 --phi-v 1 --pixel 0.2 -o board.png", 0, "");
    run("calibrate --scan board.png --map measured.png -o perfect.json", 0, "phi_s is at most 0.4 mm");
    CHECK(strstr(said, "come out 0.00") && access("measured.png", R_OK) == 0);
    run("board --printer ./perfect.json -o d.3mf", 0, "phi_s 0.4");
    run("board --phi-s 1 --phi-v 1 --pixel 0.5 -o coarse.png", 0, "");
    run("calibrate --scan coarse.png -o e.json", 1, "at least 150 dpi");
    run("calibrate --scan b.3mf -o e.json", 4, "which is not read");
    CHECK(access("e.json", F_OK) != 0);
    run("calibrate --measured solid:0.4=0.5 -o e.json", 1, "too few");
    run("calibrate --measured solid:0.4 -o e.json", 2, "kind:designed=measured");
    run("calibrate -o e.json", 2, "needs a WIDTHS");
    run("calibrate --measured solid:1=1 --map m.png -o e.json", 2, "belong to a scan");
    write_text("w.csv", "0,4,0,5,solid\n", 14);
    run("calibrate w.csv -o e.json", 4, "line 1");
}

TEST(bad_pictures_are_rejected)
{
    write_text("empty.png", "", 0);
    write_text("words.png", "hello, this is no picture at all", 32);
    write_text("cut.png", "\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
    write_text("bomb.pbm", "P4 65000 8000 ", 14);
    write_text("huge.pgm", "P5 99999999 99999999 255 ", 25);
    write_text("white.pbm", "P1 2 2 0000", 11);
    write_text("black.pbm", "P1 2 2 1111", 11);
    write_text("a.gif", "GIF89a......", 12);
    run("place empty.png -o a.png", 4, "the file is empty");
    run("place words.png -o a.png", 4, "not a picture of a known type");
    run("place cut.png -o a.png", 4, "truncated");
    run("place bomb.pbm -o a.png", 4, "too few");
    run("place huge.pgm -o a.png", 4, "too large");
    run("place white.pbm -o a.png", 4, "all white");
    run("place black.pbm -o a.png", 4, "all black");
    run("place a.gif -o a.png", 4, "this is GIF");
    run("place two.pbm -o a.png --threshold 0", 4, "all white at threshold 0");
    run("place missing.png -o a.png", 1, "No such file");
    run("place . -o a.png", 1, "directory");
    CHECK(access("a.png", F_OK) != 0);
}

static void write_job(const char *text)
{
    write_text("job.json", text, strlen(text));
}

// A plate of 24 x 19 mm with a hole of 10 x 5 mm in its middle, two.pbm 20 mm wide, laid as strokes 1 mm
// wide.
static void write_plate_gcode(const char *name)
{
    FILE *file = fopen(name, "w");
    CHECK(file);
    fprintf(file, "M83\n;HEIGHT:0.2\n;WIDTH:1\nG0 Z0.2\n");
    for (int32_t row = 0; row < 19; row++) {
        double y = 50.5 + row;
        bool hole = row >= 7 && row < 12;
        fprintf(file, "G0 X30.5 Y%.1f\nG1 X%.1f E1\n", y, hole ? 36.5 : 53.5);
        if (hole) fprintf(file, "G0 X47.5\nG1 X53.5 E1\n");
    }
    CHECK(fclose(file) == 0);
}

TEST(prints_are_compared_with_their_picture)
{
    double error = -1;
    write_plate_gcode("plate.gcode");
    run("compare two.pbm --width 20 --gcode plate.gcode -o compared.png --json compared.json", 0,
        "layers 1 to 1 of 1");
    CHECK(sscanf(printed, "error %lf %%", &error) == 1 && error > 0 &&
          error < 0.5); // the strokes' round ends
    CHECK(strstr(printed, "1 piece\n"));
    CHECK(access("compared.png", F_OK) == 0);
    run("compare two.pbm --width 20 --gcode plate.gcode --json -", 0, "");
    CHECK(printed[0] == '{' && strstr(printed, "\"precision_rate\": 0.99") &&
          strstr(printed, "\"witness\": \"gcode\""));
    run("compare two.pbm --width 20", 2, "there is no print; --gcode, --sl1 or --scan");
    run("compare two.pbm --width 20 --gcode plate.gcode --scan two.pbm", 2, "there are several prints");
    run("compare two.pbm --width 10 --gcode plate.gcode", 1,
        "24.0 x 19.0 mm large, the plate 14.0 x 11.5 mm");
    run("compare two.pbm --width 20 --gcode two.pbm", 4, "lays no plastic");
    run("compare two.pbm --width 20 --sl1 plate.gcode", 4, "no SL1 file");
    run("compare two.pbm --width 20 --scan plate.gcode", 4, "plate.gcode");
    run("compare two.pbm --width 20 --scan two.pbm", 1, "not found in the scan");
    run("compare two.pbm --width 20 --gcode nowhere.gcode", 1, "nowhere.gcode: No such file");
    run("compare two.pbm --width 20 --gcode plate.gcode -o two.pbm", 2, "does not write this type");
}

TEST(surfaces_and_jobs_are_refused_with_a_sentence)
{
    write_text("half.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n", 24);
    run("carve two.pbm -o a.3mf --surface", 2, "needs a value (SHAPE|FILE)");
    run("carve two.pbm -o a.3mf --surface vaze", 2, "there are plate, cylinder, cone, sphere and vase");
    run("carve two.pbm -o a.3mf --surface cylinder:r=-5,h=20", 2, "-5");
    run("carve two.pbm -o a.3mf --surface missing.obj", 1, "missing.obj");
    run("carve two.pbm -o a.3mf --surface half.obj", 4, "half.obj");
    run("carve two.pbm -o a.3mf --surface sphere:r=20 --place there", 2, "auto, project or wrap");
    run("carve two.pbm -o a.3mf --surface sphere:r=20 --at 1,2", 2, "three numbers");
    run("carve two.pbm -o a.3mf --surface sphere:r=20 --dir 1,2,nan", 2, "three numbers");
    run("carve two.pbm -o a.3mf --surface sphere:r=20 --camera to=1,2,3", 2, "where the eye is");
    run("carve two.pbm -o a.3mf --surface sphere:r=20 --camera from=1,2,3,fov=190", 2, "fov=DEGREES");
    run("carve two.pbm -o a.3mf --surface sphere:r=20 --repeat 0", 2, "1 .. 1000");
    run("carve two.pbm -o a.3mf --surface sphere:r=20 --width 70 --place project", 1, "a width of");
    run("carve two.pbm -o a.3mf --job job.json", 2, "one too many");
    run("carve --job nowhere.json -o a.3mf", 1, "No such file");
    write_job("{\"version\":1");
    run("carve --job job.json -o a.3mf", 4, "no JSON object");
    write_job("{\"version\":2,\"surface\":\"vase\",\"pictures\":[]}");
    run("carve --job job.json -o a.3mf", 4, "\"version\": 1");
    write_job("{\"version\":1,\"pictures\":[]}");
    run("carve --job job.json -o a.3mf", 4, "\"surface\"");
    write_job("{\"version\":1,\"surface\":\"vase\",\"pictures\":[]}");
    run("carve --job job.json -o a.3mf", 4, "0 \"pictures\"");
    write_job("{\"version\":1,\"surface\":\"vase\",\"pictures\":[{\"width\":3}]}");
    run("carve --job job.json -o a.3mf", 4, "has no \"picture\"");
    write_job("{\"version\":1,\"surface\":\"vase\",\"pictures\":[{\"picture\":\"two.pbm\",\"widht\":3}]}");
    run("carve --job job.json -o a.3mf", 4, "no option \"widht\"");
    write_job("{\"version\":1,\"surface\":\"vase\",\"pictures\":[{\"picture\":\"two.pbm\",\"width\":{}}]}");
    run("carve --job job.json -o a.3mf", 4, "no text, number, true or list");
    CHECK(access("a.3mf", F_OK) != 0);
}

static void write_sample(void)
{
    if (access("rings.png", F_OK) != 0) run("sample rings -o rings.png --size 300", 0, "");
}

// A printer's file counts from the job's folder, a picture's own figures before it.
TEST(pictures_of_a_job_have_printers)
{
    char json[TEXT_BYTES];
    const char *own = "{\"jali_printer\": 1, \"name\": \"of the job\", \"inherits\": \"lite600\"}";
    const char *text =
        "{\"version\": 1, \"surface\": \"cylinder:r=30,h=80\", \"pictures\": ["
        "{\"picture\": \"../two.pbm\", \"width\": 30, \"printer\": \"own.json\", \"phi-v\": 0.7},"
        "{\"picture\": \"../two.pbm\", \"width\": 30, \"crop\": \"0,0,3,3\", \"at\": [0, 30, 40]}]}";
    CHECK_INT(mkdir("sub", 0700), 0);
    write_text("sub/own.json", own, strlen(own));
    write_text("sub/job.json", text, strlen(text));
    run("carve --job sub/job.json --printer form1+ -o printers.stl --json printers.json", 0, "");
    read_text("printers.json", json);
    const char *first = strstr(json, "\"of the job\""), *pictures = strstr(json, "\"pictures\"");
    CHECK(first && strstr(first, "\"phi_s_mm\": 0.25") && strstr(first, "\"phi_v_mm\": 0.7"));
    CHECK(pictures && strstr(pictures, "\"width_px\": 3") && strstr(pictures, "\"form1+\"") &&
          strstr(pictures, "\"phi_s_mm\": 0.3"));
    unlink("printers.stl");
}

static void write_edits(const char *text)
{
    write_text("edits.json", text, strlen(text));
}

static int32_t bridges_in(const char *json)
{
    int32_t count = 0;
    while ((json = strstr(json, "\"bridge\"")) != NULL) {
        count++;
        json++;
    }
    return count;
}

// The bridges found are edits: given again they stand, and hardly another is needed. The sentences say what
// edits cost.
TEST(bridges_are_pinned_drawn_forbidden_and_regions_locked)
{
    char json[TEXT_BYTES];
    write_sample();
    run("adapt rings.png --width 20 -o found.png --bridges found.json", 0, "bridges laid");
    read_text("found.json", json);
    CHECK(strstr(json, "\"size\": [300, 300]") && strstr(json, "{\"kind\": \"bridge\""));
    run("adapt rings.png --width 20 -o pinned.png --edits found.json --bridges none.json", 0,
        "0 forbidden, 0 locked");
    int32_t found = bridges_in(json);
    read_text("none.json", json);
    CHECK(bridges_in(json) < found / 10); // details beside a drawn one can come out otherwise
    run("adapt rings.png --width 30 --rotate 90 --crop 10,10,280,280 --edits found.json -o edited.png", 0,
        "drawn");
    write_edits("{\"version\": 1, \"size\": [1, 1], \"edits\": [{\"kind\": \"forbid\", "
                "\"points\": [[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.8]]}]}");
    run("adapt rings.png --width 20 -o less.png --edits edits.json --json less.json", 0, "left out");
    read_text("less.json", json);
    CHECK(strstr(json, "\"forbidden\": 1") && !strstr(json, "\"left_out\": 0"));
    write_edits("{\"version\": 1, \"size\": [1, 1], \"edits\": [{\"kind\": \"lock\", "
                "\"points\": [[0, 0], [1, 0], [1, 1], [0, 1]]}]}");
    int code = finish(start("adapt rings.png --width 20 -o locked.png --edits edits.json"));
    CHECK_INT(code, 3);
    CHECK(strstr(said, "not one piece") && strstr(said, "locked or drawn by hand"));
    write_edits("{\"version\": 1, \"size\": [2, 1], \"edits\": []}");
    run("adapt rings.png -o unedited.png --edits edits.json", 0, "");
    write_edits("{\"version\": 1, \"size\": [2, 1], \"edits\": [{\"kind\": \"bridge\", "
                "\"points\": [[0, 0], [1, 1]]}]}");
    run("adapt rings.png -o b.png --edits edits.json", 4, "of another shape");
    run("adapt rings.png -o b.png --edits nowhere.json", 1, "No such file");
    run("adapt rings.png -o b.png --bridges found.json", 2, "exists");
    run("place rings.png -o b.png --edits edits.json", 2, "not an option");
    CHECK(access("b.png", F_OK) != 0);
}

TEST(pictures_are_carved_through_a_surface)
{
    write_sample();
    run("carve rings.png --surface cylinder:r=20,h=50 --repeat 3 --height 30 --backing 0.5 -o tube.3mf "
        "--json tube.json",
        0, "closed and manifold");
    run("check tube.3mf", 0, "");
    CHECK(strstr(printed, "1 piece, 1 hole through")); // a film closes the voids
    char json[TEXT_BYTES];
    read_text("tube.json", json);
    CHECK(strstr(json, "\"placing\": \"wrap\"") && strstr(json, "\"thickness_mm\": 2.0"));
    write_job(
        "{\"version\":1,\"surface\":\"vase:h=80,r=30\",\"thickness\":\"1.5mm\",\"pictures\":["
        "{\"picture\":\"rings.png\",\"width\":25},"
        "{\"picture\":\"rings.png\",\"width\":20,\"place\":\"project\",\"dir\":[0,-1,0],\"invert\":true}]}");
    run("carve --job job.json -o vase.stl -o vase.3mf --json vase.json --report vase.html", 0,
        "closed and manifold");
    run("check vase.stl", 0, "");
    CHECK(strstr(printed, "is a solid"));
    run("carve --job job.json -o vase.svg", 2, "hold them all");
    write_job("{\"version\":1,\"surface\":\"vase:h=80,r=30\",\"pictures\":["
              "{\"picture\":\"rings.png\",\"width\":25},{\"picture\":\"rings.png\",\"width\":20}]}");
    run("carve --job job.json -o both.stl", 1, "ends within"); // on top of each other
    CHECK(access("both.stl", F_OK) != 0);
}

TEST(a_picture_is_carved)
{
    write_sample();
    run("carve rings.png -o rings.3mf -o rings.stl -o rings.svg -o rings.dxf -o mask.png --json rings.json "
        "--report rings.html --width 30 --hole 3 --corner 2",
        0, "closed and manifold");
    run("check rings.3mf", 0, "");
    CHECK(strstr(printed, "1 piece") && strstr(printed, "is a solid"));
    run("check rings.stl", 0, "");
    static char text[1 << 22];
    FILE *html = fopen("rings.html", "rb");
    CHECK(html && fread(text, 1, sizeof text - 1, html) > 100000 && fclose(html) == 0);
    CHECK(strstr(text, "<h1>rings.png</h1>") && strstr(text, "A closed, manifold solid: kept"));
    CHECK(strstr(text, "http") == NULL); // nothing from outside
    char json[TEXT_BYTES];
    read_text("rings.json", json);
    CHECK(strstr(json, "\"one_piece\": true") && strstr(json, "\"self_intersections\": 0"));
}

TEST(a_picture_is_made_strong)
{
    char json[TEXT_BYTES];
    write_sample();
    run("carve rings.png -o held.3mf --width 30 --phi-s 0.8 --phi-v 0.8 --force 3 --across 2 --json "
        "held.json --report held.html "
        "--map held.png "
        "--displacement-map held.vtu",
        0, "largest stress");
    read_text("held.json", json);
    CHECK(strstr(json, "\"sound\": true") && strstr(json, "\"max_stress_mpa\"") &&
          strstr(json, "\"name\": \"pla\""));
    run("analyse rings.png --width 30 --phi-s 0.8 --phi-v 0.8 --force 3000 --across 2 --json broken.json "
        "--map broken.ply -q",
        3, "does not bear the load");
    read_text("broken.json", json);
    CHECK(strstr(json, "\"sound\": false") && strstr(json, "\"load_share\"") && !strstr(json, "nan"));
    run("carve rings.png -o light.3mf --width 30 --force 3000 --no-structure", 0, "closed and manifold");
    run("analyse light.3mf --force 0.01 --phi-s 0.8 --across 2 --json model.json --map model.vtu", 0,
        "a plate 4 mm thick");
    read_text("model.json", json);
    CHECK(strstr(json, "\"support\": \"rim\"") && strstr(json, "\"sound\": true"));
    run("carve rings.png --surface sphere:r=30 --width 20 -o round.stl --no-predict", 0, "");
    run("analyse round.stl --force 3", 1, "is no plate");
    run("list materials", 0, "");
    CHECK(strstr(printed, "petg") && strstr(printed, "MPa"));
}

TEST(bad_loads_get_a_sentence)
{
    write_sample();
    run("analyse rings.png --width 30", 2, "no load");
    run("analyse rings.png --width 30 --force nan", 2, "--force takes a number");
    run("analyse rings.png --width 30 --force 1 --pressure 1", 2, "two ways to say one thing");
    run("analyse rings.png --width 30 --force 1 --thickness 0", 2, "--thickness must be");
    run("analyse rings.png --width 30 --force 1 --material cheese", 2, "petg");
    run("analyse rings.png --width 30 --push 1,2,3", 2, "--push takes a place and a force");
    run("analyse rings.png --width 30 --force 1 --support left", 2, "picture, rim or base");
    run("analyse rings.png --width 30 --force 1 --support base", 1, "not at its base");
    run("analyse rings.png --width 30 --force 1 --map stress.jpg", 2, "a map is a .png, .ply or .vtu");
    run("adapt rings.png -o mask2.png --force 1", 2, "not an option of jali adapt");
    CHECK(access("stress.jpg", F_OK) != 0);
}

TEST(a_jali_without_petsc_says_so)
{
    char with[TEXT_BYTES];
    write_sample();
    snprintf(with, sizeof with, "%s", getenv("JALI_PROGRAM"));
    CHECK_INT(system("cp \"$JALI_PROGRAM\" alone"), 0); // nothing lies beside this one
    setenv("JALI_PROGRAM", "./alone", 1);
    run("analyse rings.png --width 30 --force 3 --solver petsc", 2, "without PETSc");
    run("analyse rings.png --width 30 --force 3 --solver=petsc --quiet", 2, "without PETSc");
    run("analyse rings.png --width 30 --force 3 --solver mumps", 2, "direct or petsc");
    run("carve rings.png -o x.3mf --force 3 --solver petsc", 2, "not an option of jali carve");
    run("analyse rings.png --width 20 --across 2 --force 0.1 --solver direct --json - -q", 0, "");
    CHECK(strstr(printed, "\"version\""));
    setenv("JALI_PROGRAM", with, 1);
}

TEST(a_picture_is_adapted)
{
    write_sample();
    run("adapt rings.png -o adapted.png --json - --width 30 --quiet", 0, "");
    CHECK(strstr(printed, "\"mesh\": null") && strstr(printed, "\"printable\": true"));
    run("adapt rings.png -o other.png --thickness 3", 2, "not an option of jali adapt");
    run("adapt rings.png -o other.stl", 2, "does not write this type; it writes .png");
}

// The same bytes for any number of threads, 3MF and all.
TEST(threads_do_not_change_a_file)
{
    write_sample();
    for (int32_t threads = 1; threads <= 3; threads++) {
        char arguments[200];
        snprintf(arguments, sizeof arguments, "carve rings.png -o t%d.3mf -o t%d.png --width 25 --threads %d",
                 threads, threads, threads);
        run(arguments, 0, "");
    }
    CHECK_INT(system("cmp t1.3mf t2.3mf && cmp t1.3mf t3.3mf && cmp t1.png t2.png && cmp t1.png t3.png"), 0);
}

TEST(a_picture_that_cannot_be_carved_is_a_sentence)
{
    write_sample();
    write_text("old.3mf", "precious", 8);
    run("carve rings.png -o old.3mf --force-overwrite --width 0.4", 1, "narrowest feature");
    run("carve rings.png -o old.3mf --force-overwrite --timeout 0.001", 5, "time limit");
    run("carve rings.png -o old.3mf", 2, "--force-overwrite replaces it");
    run("carve rings.png -o old.3mf -o full.stl --force-overwrite --frame 0 --hole 3", 2, "frame");
    run("carve rings.png -o a.obj", 2, "it writes .3mf, .stl, .svg, .dxf, .png");
    run("carve rings.png -o a.3mf --kernels 1,2", 2, "omega_c,omega_w,omega_b");
    char kept[TEXT_BYTES];
    read_text("old.3mf", kept);
    assert_string_equal(kept, "precious");
}

// A tetrahedron as text, without its last face when it shall be open.
static void write_tetrahedron(const char *name, bool closed)
{
    static const char *const face[] = {
        "0 0 0\nvertex 0 1 0\nvertex 1 0 0", "0 0 0\nvertex 1 0 0\nvertex 0 0 1",
        "0 0 0\nvertex 0 0 1\nvertex 0 1 0", "1 0 0\nvertex 0 1 0\nvertex 0 0 1"};
    FILE *stl = fopen(name, "wb");
    CHECK(stl != NULL);
    fprintf(stl, "solid t\n");
    for (int32_t i = 0; i < (closed ? 4 : 3); i++)
        fprintf(stl, "facet normal 0 0 0\nouter loop\nvertex %s\nendloop\nendfacet\n", face[i]);
    fprintf(stl, "endsolid t\n");
    CHECK(fclose(stl) == 0);
}

TEST(models_are_checked)
{
    write_tetrahedron("solid.stl", true);
    write_tetrahedron("open.stl", false);
    run("check solid.stl", 0, "");
    CHECK(strstr(printed, "4 vertices, 4 triangles") && strstr(printed, "is a solid"));
    run("check solid.stl --json -", 0, "");
    CHECK(printed[0] == '{' && strstr(printed, "\"solid\": true"));
    run("check open.stl --json open.json", 3, "open.stl is not a solid");
    CHECK(strstr(printed, "3 edges are open") && access("open.json", F_OK) == 0);
    run("check open.stl --json open.json", 2, "--force-overwrite");
    run("check two.pbm", 4, "is no STL, 3MF, OBJ");
    run("check missing.stl", 1, "No such file");
    run("check solid.stl -o a.png", 2, "not an option of jali check");
}

TEST(models_are_drawn_and_measured)
{
    if (access("rings.png", F_OK) != 0) run("sample rings -o rings.png --size 300", 0, "");
    run("carve rings.png -o drawn.stl --width 30 --no-predict --render beside.png --size 64", 0, "");
    CHECK(access("beside.png", F_OK) == 0);
    run("render drawn.stl -o day.png --size 64", 0, "");
    run("render drawn.stl -o night.png --size 64 --lamp --view 0,1,-1", 0, "");
    run("render drawn.stl -o day.png", 2, "exists");
    run("render drawn.stl -o day.jpg", 2, "does not write this type");
    run("render rings.png -o none.png", 4, "");
    run("render drawn.stl -o none.png --size 9000", 2, "8192");
    run("carve rings.png -o twice.stl --render day.bmp", 2, "ends in .png");
    CHECK(access("none.png", F_OK) != 0);
    run("check drawn.stl --walls", 0, "");
    CHECK(strstr(printed, "The thinnest wall measures"));
}

TEST(earlier_output_stays_untouched)
{
    char kept[TEXT_BYTES];
    write_text("old.png", "precious", 8);
    run("sample tree -o old.png --size 64", 2, "--force-overwrite replaces it");
    run("place missing.png -o old.png --force-overwrite", 1, "No such file");
    run("place two.pbm -o two.pbm.png -o nowhere/b.png", 1, "nowhere/b.png");
    CHECK(access("two.pbm.png", F_OK) != 0); // all of them or none
    run("place two.pbm -o old.png --force-overwrite --timeout 0.001 --width 3000 --pixel 0.05", 5,
        "time limit");
    run("place two.pbm -o old.png --force-overwrite --max-memory 1 --width 2000 --pixel 0.1", 5,
        "memory limit");
    read_text("old.png", kept);
    assert_string_equal(kept, "precious");
    run("sample tree -o old.png --size 64 --force-overwrite", 0, "");
    read_text("old.png", kept);
    CHECK(memcmp(kept, "\x89PNG", 4) == 0);
    run("place old.png -o old.png --force-overwrite", 2, "is the input");
}

TEST(a_full_disk_is_a_sentence)
{
    if (access("/dev/full", W_OK) != 0) skip();
    CHECK(symlink("/dev/full", "full.png") == 0);
    run("sample girih -o full.png", 1, "No space left");
    struct stat about;
    CHECK(lstat("full.png", &about) == 0 && S_ISLNK(about.st_mode));
}

TEST(an_unwritable_folder_is_a_sentence)
{
    if (geteuid() == 0) skip();
    CHECK(mkdir("locked", 0555) == 0);
    run("sample girih -o locked/a.png", 1, "Permission denied");
}

TEST(pipes_carry_pictures)
{
    int code = finish(
        start("sample rings -o - --size 64 | $JALI_PROGRAM place - -o - --width 20 --pixel 0.1 --quiet"));
    CHECK_INT(code, 0);
    CHECK(memcmp(printed, "\x89PNG", 4) == 0 && *said == 0);
}

TEST(svg_is_drawn_where_it_is_built_in)
{
    run("--help", 0, "");
    if (!strstr(printed, "SVG")) skip();
    static const char svg[] = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 90 60\">"
                              "<circle cx=\"45\" cy=\"30\" r=\"20\"/></svg>";
    write_text("disc.svg", svg, sizeof svg - 1);
    run("place disc.svg -o disc.png --width 45 --pixel 0.1 --frame 0", 0, "grid of 450 x 300 px");
    write_text("cut.svg", svg, sizeof svg - 20);
    run("place cut.svg -o cut.svg.png", 4, "cut.svg");
    write_text("void.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>", 47);
    run("place void.svg -o void.png", 4, "void.svg");
}

// Asleep at several looks in a row, in the program itself and no longer in the shell: it reads.
static void wait_until_it_reads(pid_t child)
{
    enum { LOOKS = 5, MOST_LOOKS = 1000 };
    struct timespec pause = {0, 20000000};
    for (int32_t looks = 0, asleep = 0; looks < MOST_LOOKS && asleep < LOOKS; looks++) {
        char path[64], stat[512] = "", *after;
        snprintf(path, sizeof path, "/proc/%d/stat", (int)child);
        nanosleep(&pause, NULL);
        read_text(path, said);
        snprintf(stat, sizeof stat, "%.500s", said);
        after = strrchr(stat, ')'); // pid (name) state
        bool program = strstr(stat, "(jali)") != NULL;
        asleep = program && after && after[2] == 'S' ? asleep + 1 : 0;
    }
}

// The program waits for its standard input, which nobody closes, and is then interrupted.
static void interrupt(int number)
{
    CHECK(access("pipe", F_OK) == 0 || mkfifo("pipe", 0600) == 0);
    int hold = open("pipe", O_RDWR);
    pid_t child = start("place - -o a.png <pipe");
    wait_until_it_reads(child);
    kill(child, number);
    CHECK_INT(finish(child), 130);
    CHECK(strstr(said, "interrupted"));
    CHECK(access("a.png", F_OK) != 0);
    close(hold);
}

TEST(an_interrupt_leaves_no_file)
{
    interrupt(SIGINT);
    interrupt(SIGTERM);
}

TEST(nothing_half_written_is_left_behind)
{
    CHECK_INT(system("ls | grep -q part"), 1 << 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_version_and_lists_go_to_stdout),
        cmocka_unit_test(usage_is_checked_before_anything_is_done),
        cmocka_unit_test(numbers_are_numbers_in_their_range),
        cmocka_unit_test(a_printer_sets_what_no_option_does),
        cmocka_unit_test(predict_says_what_a_printer_would_make_of_a_picture),
        cmocka_unit_test(a_picture_is_read_as_grey_and_cropped_by_its_own_pixels),
        cmocka_unit_test(a_profile_is_written_in_full),
        cmocka_unit_test(the_smallest_size_is_found_or_said_to_be_none),
        cmocka_unit_test(a_board_is_made_and_measured),
        cmocka_unit_test(bad_pictures_are_rejected),
        cmocka_unit_test(prints_are_compared_with_their_picture),
        cmocka_unit_test(bridges_are_pinned_drawn_forbidden_and_regions_locked),
        cmocka_unit_test(surfaces_and_jobs_are_refused_with_a_sentence),
        cmocka_unit_test(pictures_of_a_job_have_printers),
        cmocka_unit_test(pictures_are_carved_through_a_surface),
        cmocka_unit_test(a_picture_is_carved),
        cmocka_unit_test(a_picture_is_made_strong),
        cmocka_unit_test(bad_loads_get_a_sentence),
        cmocka_unit_test(a_jali_without_petsc_says_so),
        cmocka_unit_test(a_picture_is_adapted),
        cmocka_unit_test(threads_do_not_change_a_file),
        cmocka_unit_test(a_picture_that_cannot_be_carved_is_a_sentence),
        cmocka_unit_test(models_are_checked),
        cmocka_unit_test(models_are_drawn_and_measured),
        cmocka_unit_test(earlier_output_stays_untouched),
        cmocka_unit_test(a_full_disk_is_a_sentence),
        cmocka_unit_test(an_unwritable_folder_is_a_sentence),
        cmocka_unit_test(pipes_carry_pictures),
        cmocka_unit_test(svg_is_drawn_where_it_is_built_in),
        cmocka_unit_test(an_interrupt_leaves_no_file),
        cmocka_unit_test(nothing_half_written_is_left_behind),
    };
    return cmocka_run_group_tests(tests, open_folder, close_folder);
}
