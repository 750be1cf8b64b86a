// jali serve: the whole way from upload to a solid, who may ask, what a job may do, and that none is lost.
#include "testing.h"
#include "http.h"

#include <dirent.h>
#include <fcntl.h>
#include <jansson.h>
#include <math.h>
#include <pthread.h>
#include <sys/stat.h>
#include <time.h>

static char folder[] = "/tmp/jali-serve-XXXXXX";
static served page, hooked; // the program as it is, and the one with hooks and small limits
static char picture[64], hooked_picture[64];

static reply sample_of(const served *s)
{
    reply r = ask(s, "GET", "/api/v1/samples/tree.png?size=400", NULL);
    CHECK_INT(r.status, 200);
    return r;
}

static void upload(const served *s, const void *bytes, size_t size, char id[64])
{
    reply r = ask_bytes(s, "POST", "/api/v1/uploads?name=tree%2epng", bytes, size);
    CHECK_INT(r.status, 201);
    CHECK(id_of(&r, id));
    reply_free(&r);
}

static int open_servers(void **state)
{
    (void)state;
    const char *program = getenv("JALI_PROGRAM"), *other = getenv("JALI_HOOKED");
    if (!program || !*program || !other || !*other || !mkdtemp(folder) || chdir(folder) != 0) return -1;
    page = serve(program, "");
    hooked = serve(other, "--jobs 2 --job-time 120");
    if (!page.port || !hooked.port) return -1;
    reply tree = sample_of(&page);
    upload(&page, tree.body, tree.size, picture);
    upload(&hooked, tree.body, tree.size, hooked_picture);
    reply_free(&tree);
    return 0;
}

// Both end in order, and no process of theirs is left.
static int close_servers(void **state)
{
    char command[64];
    (void)state;
    int ended = stop_serving(&page, SIGTERM) + stop_serving(&hooked, SIGINT);
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return ended + system(command);
}

// Ask for a job: `rest` is what follows the picture in its JSON.
static reply ask_job(const served *s, const char *rest)
{
    char json[2048];
    snprintf(json, sizeof json, "{\"picture\": \"%s\", %s}", s == &page ? picture : hooked_picture, rest);
    return ask(s, "POST", "/api/v1/jobs", json);
}

static void start_job(const served *s, const char *rest, char id[64])
{
    reply r = ask_job(s, rest);
    if (r.status != 201) print_error("%s: %d %s\n", rest, r.status, r.body);
    CHECK_INT(r.status, 201);
    CHECK(id_of(&r, id));
    reply_free(&r);
}

static reply about_job(const served *s, const char *method, const char *id, const char *what)
{
    char path[256];
    snprintf(path, sizeof path, "/api/v1/jobs/%s%s", id, what);
    return ask(s, method, path, NULL);
}

// Follow a job to its end, which must be this event, with this exit code and words of its sentence.
static void end_job(const served *s, const char *id, const char *event, int code, const char *words)
{
    char begin[64], exits[32];
    reply r = about_job(s, "GET", id, "/events");
    snprintf(begin, sizeof begin, "event: %s\n", event);
    snprintf(exits, sizeof exits, "\"exit\":%d,", code);
    const char *last = strstr(r.body, begin);
    if (!last || !strstr(last, exits) || !strstr(last, words))
        print_error("wanted %s %d %s: %s\n", event, code, words, r.body + MAX(r.size, 400) - 400);
    CHECK(last && strstr(last, exits) && strstr(last, words));
    reply_free(&r);
}

static reply file_of(const served *s, const char *id, const char *name)
{
    char what[64];
    snprintf(what, sizeof what, "/files/%s", name);
    reply r = about_job(s, "GET", id, what);
    if (r.status != 200) print_error("%s: %d %s\n", name, r.status, r.body);
    CHECK_INT(r.status, 200);
    return r;
}

static void write_file(const char *name, const reply *r)
{
    FILE *file = fopen(name, "wb");
    CHECK(file && fwrite(r->body, 1, r->size, file) == r->size && fclose(file) == 0);
}

static int run(const char *arguments)
{
    char command[1024];
    snprintf(command, sizeof command, "%s %s", getenv("JALI_PROGRAM"), arguments);
    int state = system(command);
    return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
}

// What differs from run to run.
static void drop_times(json_t *figures)
{
    json_object_del(figures, "seconds");
    json_object_del(figures, "peak_memory_mb");
}

TEST(from_upload_to_a_solid_with_the_figures_of_the_command_line)
{
    char id[64];
    reply tree = sample_of(&page), r;
    write_file("tree.png", &tree);
    reply_free(&tree);
    start_job(&page,
              "\"options\": {\"width\": 50, \"thickness\": \"3mm\", \"pinch\": 2, "
              "\"across\": 2},"
              "\"files\": [\"object.3mf\", \"figures.json\", \"mask.png\", \"report.html\", \"outline.svg\", "
              "\"outline.dxf\","
              "\"object.stl\", \"render.png\", \"stress.png\", \"displacement.ply\", \"input.png\", "
              "\"bridges.png\","
              "\"conflicts.png\", \"errors.png\", \"mesh.bin\", \"stress.bin\"]",
              id);
    end_job(&page, id, "done", 0, "\"object.3mf\":");
    CHECK_INT(run("carve tree.png --width 50 --thickness 3mm --pinch 2 --across 2 -o own.3mf -o own.png "
                  "--json own.json -q"),
              0);
    r = file_of(&page, id, "object.3mf");
    write_file("object.3mf", &r);
    reply_free(&r);
    CHECK_INT(run("check object.3mf >check.txt 2>&1"), 0);
    CHECK_INT(system("cmp object.3mf own.3mf"), 0);
    r = file_of(&page, id, "mask.png");
    write_file("mask.png", &r);
    reply_free(&r);
    CHECK_INT(system("cmp mask.png own.png"), 0);
    r = file_of(&page, id, "figures.json");
    json_t *figures = json_loadb(r.body, r.size, 0, NULL), *own = json_load_file("own.json", 0, NULL);
    drop_times(figures);
    drop_times(own);
    CHECK(figures && own && json_equal(figures, own));
    json_decref(figures);
    json_decref(own);
    reply_free(&r);
    r = file_of(&page, id, "mesh.bin");
    const int32_t *head = (const int32_t *)(const void *)(r.body + 8);
    CHECK(memcmp(r.body, "jalimesh", 8) == 0 && head[2] == 0);
    CHECK_INT(r.size, 20 + 12 * (size_t)head[0] + 12 * (size_t)head[1]);
    reply_free(&r);
    r = file_of(&page, id, "errors.png");
    CHECK(memcmp(r.body, "\x89PNG", 4) == 0);
    reply_free(&r);
}

// By the head, a shape's corners follow with how long it is around, a model's do not.
static void check_surface(const char *surface, size_t each_triangle, float around_mm)
{
    char id[64], json[256];
    snprintf(json, sizeof json,
             "\"verb\": \"adapt\", \"options\": {\"width\": 10, \"no-predict\": true, \"surface\": \"%s\"}, "
             "\"files\": [\"surface.bin\"]",
             surface);
    start_job(&page, json, id);
    end_job(&page, id, "done", 0, "surface.bin");
    reply r = file_of(&page, id, "surface.bin");
    int32_t head[3];
    float last;
    memcpy(head, r.body + 8, sizeof head);
    memcpy(&last, r.body + r.size - sizeof last, sizeof last);
    CHECK_INT(r.size,
              20 + 12 * (size_t)head[0] + each_triangle * (size_t)head[1] + (head[2] == 2 ? sizeof last : 0));
    CHECK(memcmp(r.body, "jalimesh", 8) == 0 && (head[2] == 0 || fabsf(last - around_mm) < 1e-4F));
    reply_free(&r);
}

TEST(a_file_is_waited_for)
{
    char id[64];
    start_job(
        &page,
        "\"verb\": \"adapt\", \"options\": {\"no-predict\": true, \"grid\": 4}, \"files\": [\"mask.png\"]",
        id);
    reply r = file_of(&page, id, "mask.png?wait=1");
    CHECK(memcmp(r.body, "\x89PNG", 4) == 0);
    reply_free(&r);
    start_job(&page, "\"verb\": \"adapt\", \"options\": {\"width\": -1}, \"files\": [\"mask.png\"]", id);
    r = about_job(&page, "GET", id, "/files/mask.png?wait=1");
    CHECK_INT(r.status, 202);
    CHECK(strstr(r.body, "\"failed\"") && strstr(r.body, "width"));
    reply_free(&r);
    r = about_job(&page, "GET", "0123456789abcdef0123456789abcdef", "/files/mask.png?wait=1");
    CHECK_INT(r.status, 404);
    reply_free(&r);
}

TEST(a_surface_is_there_to_lay_pictures_on)
{
    char id[64];
    check_surface("cylinder:r=20,h=50", 36, 125.66371F);
    check_surface("plate:w=60,h=60", 36, 0);
    start_job(&page, "\"verb\": \"adapt\", \"files\": [\"surface.bin\"]", id);
    end_job(&page, id, "failed", 2, "a plate has no surface");
}

TEST(a_mesh_is_carved_and_a_printer_is_named_or_given)
{
    char id[64], mesh[64], json[512];
    static const char tetra[] =
        "OFF\n4 4 0\n-40 -20 0\n40 -20 0\n0 60 0\n0 0 90\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    upload(&page, tetra, sizeof tetra - 1, mesh);
    snprintf(json, sizeof json,
             "\"mesh\": \"%s\", \"printer\": \"fdm-0.4\", \"options\": {\"width\": 20, \"no-predict\": true, "
             "\"thickness\": 2}, \"files\": [\"figures.json\"]",
             mesh);
    start_job(&page, json, id);
    end_job(&page, id, "done", 0, "figures.json");
    reply r = file_of(&page, id, "figures.json");
    CHECK(strstr(r.body, "\"fdm-0.4\""));
    reply_free(&r);
    start_job(&page,
              "\"verb\": \"adapt\", \"printer\": {\"jali_printer\": 1, \"name\": \"mine\", \"inherits\": "
              "\"/etc/passwd.json\"},"
              "\"files\": [\"mask.png\"]",
              id);
    end_job(&page, id, "failed", 1, "opens no files");
}

TEST(a_picture_is_read_and_an_upload_comes_back)
{
    char id[64], path[96];
    reply tree = sample_of(&page), r;
    write_file("tree.png", &tree);
    start_job(&page,
              "\"verb\": \"read\", \"options\": {\"crop\": \"10,20,300,200\", \"rotate\": 90}, "
              "\"files\": [\"grey.png\", \"levels.json\"]",
              id);
    end_job(&page, id, "done", 0, "levels.json");
    CHECK_INT(run("read tree.png --crop 10,20,300,200 --rotate 90 -o grey.png --json levels.json -q"), 0);
    r = file_of(&page, id, "grey.png");
    write_file("got.png", &r);
    reply_free(&r);
    CHECK_INT(system("cmp got.png grey.png"), 0);
    r = file_of(&page, id, "levels.json");
    write_file("got.json", &r);
    CHECK(strstr(r.body, "\"width_px\": 200") && strstr(r.body, "\"threshold_auto\": 128"));
    reply_free(&r);
    CHECK_INT(system("cmp got.json levels.json"), 0);
    snprintf(path, sizeof path, "/api/v1/uploads/%s", picture);
    r = ask(&page, "GET", path, NULL);
    CHECK_INT(r.status, 200);
    CHECK(r.size == tree.size && memcmp(r.body, tree.body, r.size) == 0);
    reply_free(&r);
    reply_free(&tree);
    r = ask(&page, "GET", "/api/v1/uploads/0123", NULL);
    CHECK_INT(r.status, 404);
    reply_free(&r);
}

TEST(a_profile_is_read_as_the_command_line_reads_it)
{
    char id[64], kept[64];
    static const char prusa[] = "; generated by PrusaSlicer\nnozzle_diameter = 0.6\nlayer_height = 0.3\n"
                                "printer_settings_id = Workshop\nfilament_type = PETG\n"
                                "perimeter_generator = arachne\nmin_bead_width = 85%\n";
    memcpy(kept, picture, sizeof kept);
    upload(&page, prusa, sizeof prusa - 1, picture);
    start_job(&page, "\"name\": \"shop.ini\", \"verb\": \"printer\", \"files\": [\"printer.json\"]", id);
    end_job(&page, id, "done", 0, "printer.json");
    reply r = file_of(&page, id, "printer.json");
    CHECK(strstr(r.body, "\"Workshop\"") && strstr(r.body, "min_bead_width"));
    reply_free(&r);
    start_job(&page, "\"name\": \"shop.ini\", \"verb\": \"printer\", \"files\": [\"mask.png\"]", id);
    end_job(&page, id, "failed", 2, "jali printer does not make mask.png");
    memcpy(picture, kept, sizeof kept);
    start_job(&page, "\"name\": \"x.ini\", \"verb\": \"printer\", \"files\": [\"printer.json\"]", id);
    end_job(&page, id, "failed", 4, "x.ini");
    start_job(&page, "\"verb\": \"adapt\", \"files\": [\"grey.png\"]", id);
    end_job(&page, id, "failed", 2, "jali adapt does not make grey.png");
    start_job(&page, "\"verb\": \"read\", \"files\": [\"errors.png\"]", id);
    end_job(&page, id, "failed", 2, "jali read does not make errors.png");
}

TEST(a_job_takes_edits_and_gives_bridges)
{
    char id[64];
    start_job(&page,
              "\"verb\": \"adapt\", \"options\": {\"width\": 20, \"no-predict\": true}, \"edits\": "
              "{\"version\": 1, \"size\": [1, 1], \"edits\": [{\"kind\": \"bridge\", \"points\": [[0.5, "
              "0.5], [0.5, "
              "1]]}]}, \"files\": [\"figures.json\", \"bridges.json\"]",
              id);
    end_job(&page, id, "done", 0, "bridges.json");
    reply r = file_of(&page, id, "figures.json");
    CHECK(strstr(r.body, "\"edits\": {") && strstr(r.body, "\"forbidden\": 0"));
    reply_free(&r);
    r = file_of(&page, id, "bridges.json");
    CHECK(strstr(r.body, "\"version\": 1") && strstr(r.body, "\"size\""));
    reply_free(&r);
    start_job(&page, "\"edits\": {\"version\": 1, \"size\": 3}, \"files\": [\"mask.png\"]", id);
    end_job(&page, id, "failed", 4, "edits.json has no \\\"size\\\"");
    start_job(&page, "\"options\": {\"edits\": \"/etc/passwd\"}, \"files\": [\"mask.png\"]", id);
    end_job(&page, id, "failed", 1, "opens no files");
    r = ask_job(&page, "\"edits\": [], \"files\": [\"mask.png\"]");
    CHECK(r.status == 400 && strstr(r.body, "is an object"));
    reply_free(&r);
}

TEST(a_job_fails_as_the_command_line_does)
{
    char id[64], text[64];
    static const char *const cases[][2] = {{"\"width\": -3", "--width must be"},
                                           {"\"width\": \"wide\"", "--width takes a number"},
                                           {"\"wdth\": 3", "there is no option"},
                                           {"\"surface\": \"/etc/passwd\"", "opens no files"},
                                           {"\"surface\": \"vase:profile=/etc/passwd\"", "opens no files"},
                                           {"\"printer\": \"/etc/passwd.json\"", "opens no files"},
                                           {"\"job\": \"/etc/passwd\"", "there is no option"},
                                           {"\"output\": \"x.png\"", "there is no option"},
                                           {"\"json\": \"x.json\"", "there is no option"},
                                           {"\"map\": \"x.png\"", "files of the job"},
                                           {"\"threads\": 1000", "there is no option"}};
    static const int code[] = {2, 2, 2, 1, 1, 1, 2, 2, 2, 2, 2};
    for (size_t i = 0; i < sizeof code / sizeof *code; i++) {
        char rest[256];
        snprintf(rest, sizeof rest, "\"options\": {%s}, \"files\": [\"object.3mf\"]", cases[i][0]);
        start_job(&page, rest, id);
        end_job(&page, id, "failed", code[i], cases[i][1]);
    }
    reply sent = ask(&page, "POST", "/api/v1/uploads?name=%E7%8B%AE.txt", "this is no picture");
    CHECK(id_of(&sent, text));
    reply_free(&sent);
    char json[256];
    snprintf(json, sizeof json, "{\"picture\": \"%s\", \"files\": [\"mask.png\"]}", text);
    reply r = ask(&page, "POST", "/api/v1/jobs", json);
    CHECK(id_of(&r, id));
    reply_free(&r);
    end_job(&page, id, "failed", 4, "\xe7\x8b\xae.txt: not a picture");
    upload(&page, "<svg xmlns='http://www.w3.org/2000/svg'><text>a</text></svg>", 60, text);
    snprintf(json, sizeof json, "{\"picture\": \"%s\", \"files\": [\"mask.png\"]}", text);
    r = ask(&page, "POST", "/api/v1/jobs", json);
    CHECK(id_of(&r, id));
    reply_free(&r);
    end_job(&page, id, "failed", 4, "PNG");
}

// A request line and headers; @ is the port, ~ the token.
static void knock(const char *lines, int status)
{
    char head[2048];
    size_t size = 0;
    for (const char *c = lines; *c && size < sizeof head - 64; c++) {
        if (*c == '@')
            size += (size_t)snprintf(head + size, 16, "%d", page.port);
        else if (*c == '~')
            size += (size_t)snprintf(head + size, 40, "%s", page.token);
        else if (*c == '\n')
            size += (size_t)snprintf(head + size, 4, "\r\n");
        else
            head[size++] = *c;
    }
    snprintf(head + size, sizeof head - size, "Connection: close\r\n\r\n");
    reply r = ask_raw(&page, head, "", 0);
    if (r.status != status) print_error("%s: %d (wanted %d) %s\n", lines, r.status, status, r.text);
    CHECK_INT(r.status, status);
    CHECK(!strcasestr(r.text, "Access-Control"));
    if (r.status) CHECK(strstr(r.text, "Content-Security-Policy: default-src 'none'") || status == 400);
    reply_free(&r);
}

TEST(only_our_own_page_may_ask)
{
    knock("GET / HTTP/1.1\nHost: 127.0.0.1:@\n", 200);
    knock("GET / HTTP/1.1\nHost: localhost:@\n", 200);
    knock("GET /api/v1/lists HTTP/1.1\nHost: localhost:@\nX-Jali-Token: ~\nOrigin: http://localhost:@\n",
          200);
    knock("GET /api/v1/version HTTP/1.1\nHost: 127.0.0.1:@\nX-Jali-Token: ~\nSec-Fetch-Site: same-origin\n",
          200);
    knock("GET / HTTP/1.1\nHost: evil.example:@\n", 403);
    knock("GET / HTTP/1.1\nHost: 127.0.0.1\n", 403);
    knock("GET / HTTP/1.1\nHost: 127.0.0.1:@@\n", 403);
    knock("GET /api/v1/version HTTP/1.1\nHost: 127.0.0.1:@\nHost: evil.example\nX-Jali-Token: ~\n", 403);
    knock("GET /api/v1/version HTTP/1.1\nHost: 127.0.0.1:@\n", 403);
    knock("GET /api/v1/version HTTP/1.1\nHost: 127.0.0.1:@\nX-Jali-Token: ~0\n", 403);
    knock("GET /api/v1/version HTTP/1.1\nHost: 127.0.0.1:@\nX-Jali-Token: 0123456789abcdef0123456789abcdef\n",
          403);
    knock("GET /api/v1/version?token=~ HTTP/1.1\nHost: 127.0.0.1:@\n", 403);
    knock("GET /api/v1/version HTTP/1.1\nHost: 127.0.0.1:@\nX-Jali-Token: ~\nOrigin: http://evil.example\n",
          403);
    knock("GET /api/v1/version HTTP/1.1\nHost: 127.0.0.1:@\nX-Jali-Token: ~\nOrigin: null\n", 403);
    knock("GET /api/v1/version HTTP/1.1\nHost: 127.0.0.1:@\nX-Jali-Token: ~\nOrigin: https://127.0.0.1:@\n",
          403);
    knock("GET /api/v1/version HTTP/1.1\nHost: 127.0.0.1:@\nX-Jali-Token: ~\nSec-Fetch-Site: cross-site\n",
          403);
    // What a browser asks before it sends a header of another origin's page: no answer says yes.
    knock("OPTIONS /api/v1/jobs HTTP/1.1\nHost: 127.0.0.1:@\nOrigin: http://evil.example\n"
          "Access-Control-Request-Headers: x-jali-token\n",
          403);
    knock("OPTIONS /api/v1/jobs HTTP/1.1\nHost: 127.0.0.1:@\nX-Jali-Token: ~\n", 405);
    knock("POST / HTTP/1.1\nHost: 127.0.0.1:@\nContent-Length: 0\n", 405);
    knock("GET / HTTP/1.1\n", 400); // no Host
}

TEST(paths_lead_nowhere)
{
    static const char *const paths[] = {"/../../etc/passwd",
                                        "/..%2f..%2fetc/passwd",
                                        "/%2e%2e/etc/passwd",
                                        "//etc/passwd",
                                        "/index.html/..",
                                        "/web/dist/index.html",
                                        "/api/v1/samples/..%2f..%2fetc.png",
                                        "/api/v1/samples/",
                                        "/api/v1/jobs//events",
                                        "/api/v1/jobs/x/files/..",
                                        "/api/v1/jobs/x/files/mask.png/",
                                        "/api/v1/",
                                        "/api/v2/version",
                                        "/index.html%00.png"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        reply r = ask(&page, "GET", paths[i], NULL);
        if (r.status != 404) print_error("%s: %d %s\n", paths[i], r.status, r.body);
        CHECK_INT(r.status, 404);
        reply_free(&r);
    }
    static const char unknown[] = "00000000000000000000000000000000";
    static const char *const what[] = {"", "/events", "/files/mask.png"};
    for (int i = 0; i < 3; i++) {
        reply r = about_job(&page, "GET", unknown, what[i]);
        CHECK_INT(r.status, 404);
        reply_free(&r);
    }
    reply r = about_job(&page, "DELETE", unknown, "");
    CHECK_INT(r.status, 404);
    reply_free(&r);
}

static void refuse_job(const char *json, int status, const char *words)
{
    reply r = ask(&page, "POST", "/api/v1/jobs", json);
    if (r.status != status || !strstr(r.body, words)) print_error("%s: %d %s\n", json, r.status, r.body);
    CHECK_INT(r.status, status);
    CHECK(strstr(r.body, words));
    reply_free(&r);
}

TEST(jobs_that_make_no_sense_are_refused)
{
    char deep[9000] = "{\"options\":";
    refuse_job("{", 400, "no JSON");
    refuse_job("[]", 400, "object");
    refuse_job("{\"files\": [\"mask.png\"]}", 400, "picture");
    refuse_job("{\"picture\": \"x\", \"picture\": \"y\"}", 400, "no JSON");
    refuse_job("{\"picture\": \"nothing\", \"files\": [\"mask.png\"]}", 404, "nothing");
    refuse_job("{\"picture\": 3, \"files\": [\"mask.png\"]}", 400, "text");
    refuse_job("{\"picture\": \"x\", \"files\": []}", 400, "files");
    refuse_job("{\"picture\": \"x\", \"files\": [\"../mask.png\"]}", 400, "no file");
    refuse_job("{\"picture\": \"x\", \"files\": [\"mask.png\", \"mask.png\"]}", 400, "twice");
    refuse_job("{\"picture\": \"x\", \"fils\": [\"mask.png\"]}", 400, "\\\"fils\\\"");
    refuse_job("{\"picture\": \"x\", \"hook\": \"open\", \"files\": [\"mask.png\"]}", 400, "hook");
    refuse_job("{\"picture\": \"x\", \"client\": \"a\\u0000b\", \"files\": [\"mask.png\"]}", 400, "");
    reply r = ask_job(&page, "\"verb\": \"serve\", \"files\": [\"mask.png\"]");
    CHECK_INT(r.status, 400);
    reply_free(&r);
    r = ask_job(&page, "\"printer\": \"/etc/passwd.json\", \"files\": [\"mask.png\"]");
    CHECK(r.status == 400 && strstr(r.body, "not a file"));
    reply_free(&r);
    r = ask_job(&page, "\"printer\": \"fdm-0.5\", \"files\": [\"mask.png\"]");
    CHECK(r.status == 400 && strstr(r.body, "did you mean fdm-0."));
    reply_free(&r);
    memset(deep + strlen(deep), '[', 8000);
    refuse_job(deep, 400, "no JSON");
}

TEST(bodies_have_their_size_and_their_time)
{
    char head[512], id[64];
    static char block[1 << 21];
    static const char *const lengths[] = {"Content-Length: 1000000000000", "Content-Length: 0",
                                          "Content-Length: -1", "Transfer-Encoding: chunked", "X-Nothing: 1"};
    static const int status[] = {413, 400, 400, 411, 411};
    for (size_t i = 0; i < sizeof status / sizeof *status; i++) {
        snprintf(head, sizeof head,
                 "POST /api/v1/uploads HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nConnection: close\r\nX-Jali-Token: "
                 "%s\r\n%s\r\n\r\n",
                 page.port, page.token, lengths[i]);
        reply r = ask_raw(&page, head, "0\r\n\r\n", i == 3 ? 5 : 0);
        if (r.status != status[i]) print_error("%s: %d\n", lengths[i], r.status);
        CHECK_INT(r.status, status[i]);
        reply_free(&r);
    }
    // Half a body, then nothing; half a head, then nothing: both are cut off, of the latter nothing is said.
    time_t begun = time(NULL);
    snprintf(head, sizeof head,
             "POST /api/v1/uploads HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nX-Jali-Token: %s\r\nContent-Length: "
             "100\r\n\r\n",
             hooked.port, hooked.token);
    reply r = ask_raw(&hooked, head, "half", 4);
    CHECK(r.status == 0 && time(NULL) - begun < 30);
    reply_free(&r);
    r = ask_raw(&hooked, "GET / HT", "", 0);
    CHECK(r.status == 0 || r.status == 400);
    reply_free(&r);
    // More than there is room for: what was used least has to go, what is used stays.
    for (int i = 0; i < 8; i++) {
        upload(&hooked, block, sizeof block, id);
        start_job(&hooked,
                  "\"verb\": \"adapt\", \"options\": {\"no-predict\": true}, \"files\": [\"mask.png\"]", id);
        end_job(&hooked, id, "done", 0, "mask.png");
    }
}

// --- What a job may do

TEST(a_job_that_tries_what_it_may_not_is_ended)
{
    static const char *const hooks[] = {"open", "socket", "process", "exec", "signal", "code"};
    for (size_t i = 0; i < sizeof hooks / sizeof *hooks; i++) {
        char rest[128], id[64];
        snprintf(rest, sizeof rest, "\"hook\": \"%s\", \"files\": [\"mask.png\"]", hooks[i]);
        start_job(&hooked, rest, id);
        end_job(&hooked, id, "failed", 1, "tried what it may not");
    }
}

TEST(a_job_that_crashes_or_lies_is_its_own_loss)
{
    char id[64], other[64];
    start_job(&hooked, "\"hook\": \"spin\", \"files\": [\"mask.png\"]", other);
    start_job(&hooked, "\"hook\": \"lie\", \"files\": [\"mask.png\"]", id);
    end_job(&hooked, id, "failed", 1, "");
    start_job(&hooked, "\"hook\": \"crash\", \"files\": [\"mask.png\"]", id);
    end_job(&hooked, id, "failed", 1, "");
    start_job(&hooked, "\"verb\": \"adapt\", \"files\": [\"mask.png\"]", id);
    end_job(&hooked, id, "done", 0, "mask.png");
    reply r = about_job(&hooked, "DELETE", other, "");
    CHECK_INT(r.status, 200);
    reply_free(&r);
}

TEST(a_job_that_does_not_end_is_ended)
{
    char id[64], json[256];
    served s = serve(getenv("JALI_HOOKED"), "--job-time 1");
    reply tree = sample_of(&page), r;
    upload(&s, tree.body, tree.size, id);
    reply_free(&tree);
    snprintf(json, sizeof json, "{\"picture\": \"%s\", \"hook\": \"spin\", \"files\": [\"mask.png\"]}", id);
    r = ask(&s, "POST", "/api/v1/jobs", json);
    CHECK(id_of(&r, id));
    reply_free(&r);
    end_job(&s, id, "failed", 5, "--job-time");
    CHECK_INT(stop_serving(&s, SIGTERM), 0);
}

// The processes a server has started.
static int32_t children_of(pid_t parent, pid_t *child, int32_t most)
{
    int32_t count = 0;
    DIR *all = opendir("/proc");
    for (struct dirent *entry; all && (entry = readdir(all)) && count < most;) {
        char path[300], state;
        int pid = atoi(entry->d_name), above = 0;
        snprintf(path, sizeof path, "/proc/%s/stat", entry->d_name);
        FILE *file = pid > 0 ? fopen(path, "r") : NULL;
        if (!file) continue;
        if (fscanf(file, "%*d (%*[^)]) %c %d", &state, &above) == 2 && above == parent && state != 'Z')
            child[count++] = pid;
        fclose(file);
    }
    if (all) closedir(all);
    return count;
}

static void wait_until_running(const char *id)
{
    for (int i = 0; i < 1000; i++) {
        reply r = about_job(&hooked, "GET", id, "");
        bool runs = r.text && strstr(r.body, "\"running\"");
        reply_free(&r);
        if (runs) return;
        nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
    }
    CHECK(!"it runs");
}

TEST(a_killed_job_is_a_sentence_and_the_next_one_runs)
{
    char id[64];
    pid_t child[16];
    start_job(&hooked, "\"hook\": \"spin\", \"files\": [\"mask.png\"]", id);
    wait_until_running(id);
    int32_t count = children_of(hooked.pid, child, 16);
    CHECK(count >= 1);
    for (int32_t i = 0; i < count; i++) kill(child[i], SIGKILL); // the one that waits as well
    end_job(&hooked, id, "failed", 1, "signal");
    for (int32_t i = 0; i < count; i++)
        while (kill(child[i], 0) == 0) nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    start_job(&hooked, "\"verb\": \"adapt\", \"files\": [\"mask.png\"]", id);
    end_job(&hooked, id, "done", 0, "mask.png");
}

TEST(the_newest_request_of_a_client_wins_and_jobs_are_cancelled)
{
    char first[64], queued[64], other[64], last[64];
    start_job(&hooked, "\"client\": \"a\", \"hook\": \"spin\", \"files\": [\"mask.png\"]", first);
    start_job(&hooked, "\"client\": \"b\", \"hook\": \"spin\", \"files\": [\"mask.png\"]", other);
    wait_until_running(first);
    wait_until_running(other);
    start_job(&hooked, "\"client\": \"a\", \"verb\": \"adapt\", \"files\": [\"input.png\"]", queued);
    start_job(&hooked, "\"client\": \"a\", \"verb\": \"adapt\", \"files\": [\"mask.png\"]", last);
    end_job(&hooked, first, "failed", 130, "newer");
    end_job(&hooked, last, "done", 0, "mask.png");
    reply r = about_job(&hooked, "GET", queued, "");
    CHECK(strstr(r.body, "newer") || strstr(r.body, "done"));
    reply_free(&r);
    r = about_job(&hooked, "GET", other, "");
    CHECK(strstr(r.body, "\"running\""));
    reply_free(&r);
    r = about_job(&hooked, "DELETE", other, "");
    CHECK_INT(r.status, 200);
    reply_free(&r);
    r = about_job(&hooked, "GET", other, "");
    CHECK_INT(r.status, 404);
    reply_free(&r);
    pid_t child[16];
    int32_t count = 16;
    for (int i = 0; i < 300 && count > 2; i++) { // two wait for the next jobs
        nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
        count = children_of(hooked.pid, child, 16);
    }
    CHECK(count <= 2);
}

enum { AT_ONCE = 50 };

typedef struct one_of_many {
    int number;
    bool right;
} one_of_many;

// Each asks for a width of its own, and must get the figures of that.
static void *ask_for_own_width(void *data)
{
    one_of_many *one = data;
    char rest[256], id[64], what[] = "/files/figures.json";
    double width = 0;
    snprintf(rest, sizeof rest,
             "\"verb\": \"adapt\", \"options\": {\"width\": %d, \"pixel\": 0.1, \"no-predict\": true}, "
             "\"files\": [\"figures.json\", "
             "\"mask.png\"]",
             20 + one->number);
    reply r = ask_job(&page, rest);
    bool known = id_of(&r, id);
    reply_free(&r);
    if (!known) return NULL;
    r = about_job(&page, "GET", id, "/events");
    bool done = r.text && strstr(r.body, "event: done");
    reply_free(&r);
    r = about_job(&page, "GET", id, what);
    json_t *figures = r.text ? json_loadb(r.body, r.size, 0, NULL) : NULL;
    width = json_real_value(json_array_get(json_object_get(figures, "size_mm"), 0));
    one->right = done && width > 20 + one->number - 0.2 && width < 20 + one->number + 0.2;
    json_decref(figures);
    reply_free(&r);
    return NULL;
}

TEST(fifty_jobs_at_once_none_lost_none_mixed_up)
{
    pthread_t thread[AT_ONCE];
    one_of_many one[AT_ONCE] = {0};
    for (int i = 0; i < AT_ONCE; i++) {
        one[i].number = i;
        CHECK_INT(pthread_create(&thread[i], NULL, ask_for_own_width, &one[i]), 0);
    }
    for (int i = 0; i < AT_ONCE; i++) pthread_join(thread[i], NULL);
    for (int i = 0; i < AT_ONCE; i++) {
        if (!one[i].right) print_error("number %d is lost or mixed up\n", i);
        CHECK(one[i].right);
    }
}

TEST(the_servers_end_is_the_end_of_its_jobs)
{
    char address[64], id[64], json[256];
    pid_t child[16];
    for (int hard = 0; hard < 2; hard++) {
        served s = serve(getenv("JALI_HOOKED"), "--jobs 1");
        reply tree = sample_of(&page);
        upload(&s, tree.body, tree.size, address);
        reply_free(&tree);
        snprintf(json, sizeof json, "{\"picture\": \"%s\", \"hook\": \"spin\", \"files\": [\"mask.png\"]}",
                 address);
        reply r = ask(&s, "POST", "/api/v1/jobs", json);
        CHECK(id_of(&r, id));
        reply_free(&r);
        int32_t count = 0;
        for (int i = 0; i < 300 && count < 2; i++) {
            nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
            count = children_of(s.pid, child, 16);
        }
        CHECK_INT(count, 2);
        CHECK_INT(stop_serving(&s, hard ? SIGKILL : SIGTERM), hard ? 1000 + SIGKILL : 0);
        for (int i = 0; i < 300; i++) {
            if (kill(child[0], 0) != 0 && kill(child[1], 0) != 0) break;
            nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
        }
        CHECK(kill(child[0], 0) != 0 && kill(child[1], 0) != 0);
    }
}

TEST(what_cannot_be_served_is_said)
{
    char arguments[256];
    snprintf(arguments, sizeof arguments, "serve --port %d 2>said.txt", page.port);
    CHECK_INT(run(arguments), 1);
    CHECK_INT(system("grep -q 'is taken.*--port 0' said.txt"), 0);
    CHECK_INT(run("serve --port 0 none.png 2>said.txt"), 1);
    CHECK_INT(system("grep -q none.png said.txt"), 0);
    CHECK_INT(run("work 2>said.txt"), 2);
    served s = serve(getenv("JALI_PROGRAM"), "tree.png");
    reply r = ask(&s, "GET", "/api/v1/lists", NULL);
    CHECK(strstr(r.body, "\"name\":\"tree.png\"") && strstr(r.body, "\"name\":\"girih\""));
    reply_free(&r);
    CHECK_INT(stop_serving(&s, SIGTERM), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(from_upload_to_a_solid_with_the_figures_of_the_command_line),
        cmocka_unit_test(a_file_is_waited_for),
        cmocka_unit_test(a_surface_is_there_to_lay_pictures_on),
        cmocka_unit_test(a_job_takes_edits_and_gives_bridges),
        cmocka_unit_test(a_mesh_is_carved_and_a_printer_is_named_or_given),
        cmocka_unit_test(a_picture_is_read_and_an_upload_comes_back),
        cmocka_unit_test(a_profile_is_read_as_the_command_line_reads_it),
        cmocka_unit_test(a_job_fails_as_the_command_line_does),
        cmocka_unit_test(only_our_own_page_may_ask),
        cmocka_unit_test(paths_lead_nowhere),
        cmocka_unit_test(jobs_that_make_no_sense_are_refused),
        cmocka_unit_test(bodies_have_their_size_and_their_time),
        cmocka_unit_test(a_job_that_tries_what_it_may_not_is_ended),
        cmocka_unit_test(a_job_that_crashes_or_lies_is_its_own_loss),
        cmocka_unit_test(a_job_that_does_not_end_is_ended),
        cmocka_unit_test(a_killed_job_is_a_sentence_and_the_next_one_runs),
        cmocka_unit_test(the_newest_request_of_a_client_wins_and_jobs_are_cancelled),
        cmocka_unit_test(fifty_jobs_at_once_none_lost_none_mixed_up),
        cmocka_unit_test(the_servers_end_is_the_end_of_its_jobs),
        cmocka_unit_test(what_cannot_be_served_is_said),
    };
    return cmocka_run_group_tests(tests, open_servers, close_servers);
}
