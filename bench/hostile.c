// Ten thousand hostile requests to jali serve, and what has changed after them; how soon a preview comes.
//
//     hostile JALI [REQUESTS]
//
// Each kind of request is sent in turn, some of them with random bytes, from a few threads at a time.
// Meanwhile a client of the right token works on; afterwards its upload and its results are the same bytes,
// the server holds no more files and hardly more memory than before, and no process is left.
#include "http.h"

#include <dirent.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <time.h>

enum { THREADS = 8, KINDS = 16, SLOW_EVERY = 100, PREVIEWS = 30 };

typedef struct kind {
    const char *what;
    int wanted;        // status; 0 = cut off, or any refusal
    const char *lines; // @ port, ~ token, ? random bytes; body after an empty line
} kind;

static const kind kinds[KINDS] = {
    {"wrong Host", 403, "GET /api/v1/lists HTTP/1.1\r\nHost: evil.example:@\r\nX-Jali-Token: ~\r\n\r\n"},
    {"foreign Origin", 403,
     "POST /api/v1/jobs HTTP/1.1\r\nHost: 127.0.0.1:@\r\nOrigin: http://evil.example\r\nX-Jali-Token: "
     "~\r\nContent-Length: 2\r\n\r\n{}"},
    {"preflight of another origin", 403,
     "OPTIONS /api/v1/jobs HTTP/1.1\r\nHost: 127.0.0.1:@\r\nOrigin: "
     "http://evil.example\r\nAccess-Control-Request-Method: POST\r\n\r\n"},
    {"no token", 403, "DELETE /api/v1/jobs/* HTTP/1.1\r\nHost: 127.0.0.1:@\r\n\r\n"},
    {"guessed token", 403,
     "DELETE /api/v1/jobs/* HTTP/1.1\r\nHost: 127.0.0.1:@\r\nX-Jali-Token: "
     "00000000000000000000000000000000\r\n\r\n"},
    {"another site's script", 403,
     "GET /api/v1/jobs/* HTTP/1.1\r\nHost: 127.0.0.1:@\r\nSec-Fetch-Site: cross-site\r\nX-Jali-Token: "
     "~\r\n\r\n"},
    {"giant body, announced", 413,
     "POST /api/v1/uploads HTTP/1.1\r\nHost: 127.0.0.1:@\r\nX-Jali-Token: ~\r\nContent-Length: "
     "99999999999999\r\n\r\nxxxx"},
    {"body without end", 411,
     "POST /api/v1/uploads HTTP/1.1\r\nHost: 127.0.0.1:@\r\nX-Jali-Token: ~\r\nTransfer-Encoding: "
     "chunked\r\n\r\nffffffff\r\nxxxx"},
    {"giant head", 0, "GET /?########## HTTP/1.1\r\nHost: 127.0.0.1:@\r\n\r\n"},
    {"no JSON", 400,
     "POST /api/v1/jobs HTTP/1.1\r\nHost: 127.0.0.1:@\r\nX-Jali-Token: ~\r\nContent-Length: "
     "16\r\n\r\n????????????????"},
    {"JSON of another shape", 400,
     "POST /api/v1/jobs HTTP/1.1\r\nHost: 127.0.0.1:@\r\nX-Jali-Token: ~\r\nContent-Length: "
     "28\r\n\r\n{\"picture\":[],\"files\":{\"a\":1"},
    {"a job of nothing", 404,
     "POST /api/v1/jobs HTTP/1.1\r\nHost: 127.0.0.1:@\r\nX-Jali-Token: ~\r\nContent-Length: 39\r\n\r\n"
     "{\"picture\":\"../x\",\"files\":[\"mask.png\"]}"},
    {"path out of the folder", 404,
     "GET /../../../../etc/passwd HTTP/1.1\r\nHost: 127.0.0.1:@\r\nX-Jali-Token: ~\r\n\r\n"},
    {"path in disguise", 404,
     "GET /%2e%2e/%2e%2e/etc/passwd%00.html HTTP/1.1\r\nHost: 127.0.0.1:@\r\nX-Jali-Token: ~\r\n\r\n"},
    {"file of no job", 404,
     "GET /api/v1/jobs/../files/..%2f..%2fetc%2fpasswd HTTP/1.1\r\nHost: 127.0.0.1:@\r\nX-Jali-Token: "
     "~\r\n\r\n"},
    {"noise", 0, "????????????????????????????????????????????????????????????????\r\n\r\n"},
};

static served page;
static char job[64];
static int requests;
static atomic_int next, as_wanted[KINDS], otherwise[KINDS], slow_cut;

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static size_t fill(const char *lines, uint64_t *seed, char *to, size_t room)
{
    size_t size = 0;
    for (const char *c = lines; *c && size < room - 8192; c++) {
        if (*c == '@')
            size += (size_t)sprintf(to + size, "%d", page.port);
        else if (*c == '~')
            size += (size_t)sprintf(to + size, "%s", page.token);
        else if (*c == '*')
            size += (size_t)sprintf(to + size, "%s", job);
        else if (*c == '#')
            for (int i = 0; i < 5000; i++) to[size++] = 'a';
        else if (*c == '?')
            *seed = *seed * UINT64_C(6364136223846793005) + 1442695040888963407U,
            to[size++] = (char)(*seed >> 56);
        else
            to[size++] = *c;
    }
    return size;
}

static void *attack(void *unused)
{
    static _Thread_local char request[1 << 17];
    (void)unused;
    for (int i; (i = atomic_fetch_add(&next, 1)) < requests;) {
        uint64_t seed = (uint64_t)i + 1;
        const kind *k = &kinds[i % KINDS];
        size_t size = fill(k->lines, &seed, request, sizeof request);
        int opened = connect_to(&page);
        if (opened < 0) {
            atomic_fetch_add(&otherwise[i % KINDS], 1);
            continue;
        }
        send_all(opened, request, size);
        shutdown(opened, SHUT_WR);
        reply r = read_reply(opened);
        close(opened);
        int status = r.status;
        reply_free(&r);
        bool right = k->wanted ? status == k->wanted : status == 0 || status >= 400;
        atomic_fetch_add(right ? &as_wanted[i % KINDS] : &otherwise[i % KINDS], 1);
    }
    return NULL;
}

// A body that begins and never ends; the server has to be the one to end it.
static void *linger(void *unused)
{
    char head[512];
    (void)unused;
    snprintf(head, sizeof head,
             "POST /api/v1/uploads HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nX-Jali-Token: %s\r\nContent-Length: "
             "1000000\r\n\r\nx",
             page.port, page.token);
    int opened = connect_to(&page);
    if (opened < 0) return NULL;
    send_all(opened, head, strlen(head));
    for (int i = 0; i < 60; i++) { // a byte a second
        char byte = 'x';
        if (recv(opened, &byte, 1, MSG_DONTWAIT) == 0 || send(opened, &byte, 1, MSG_NOSIGNAL) <= 0) {
            atomic_fetch_add(&slow_cut, 1);
            break;
        }
        nanosleep(&(struct timespec){.tv_sec = 1}, NULL);
    }
    close(opened);
    return NULL;
}

static long number_in(const char *file, const char *key)
{
    char path[64], line[256];
    long number = -1;
    snprintf(path, sizeof path, "/proc/%d/%s", (int)page.pid, file);
    FILE *in = fopen(path, "r");
    while (in && fgets(line, sizeof line, in))
        if (strncmp(line, key, strlen(key)) == 0) number = strtol(line + strlen(key), NULL, 10);
    if (in) fclose(in);
    return number;
}

static int files_open(void)
{
    char path[64];
    int count = 0;
    snprintf(path, sizeof path, "/proc/%d/fd", (int)page.pid);
    DIR *all = opendir(path);
    for (struct dirent *entry; all && (entry = readdir(all));) count += entry->d_name[0] != '.';
    if (all) closedir(all);
    return count;
}

static void start(const char *picture, const char *what, char id[64])
{
    char json[512];
    snprintf(json, sizeof json, "{\"picture\": \"%s\", %s}", picture, what);
    reply r = ask(&page, "POST", "/api/v1/jobs", json);
    id_of(&r, id);
    reply_free(&r);
}

static reply about(const char *id, const char *what)
{
    char path[128];
    snprintf(path, sizeof path, "/api/v1/jobs/%s%s", id, what);
    return ask(&page, "GET", path, NULL);
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_times(const char *name, const char *what, double taken[PREVIEWS])
{
    qsort(taken, PREVIEWS, sizeof *taken, by_value);
    printf("%-10s %-40s fastest %4.0f ms, median %4.0f ms, slowest %4.0f ms\n", name, what, 1e3 * taken[0],
           1e3 * taken[PREVIEWS / 2], 1e3 * taken[PREVIEWS - 1]);
}

// From the request to the last byte of mask.png; and the same by the command line, in turn.
static void time_previews(const char *program, const char *name, const char *picture)
{
    char command[1024];
    double served_in[PREVIEWS], run_in[PREVIEWS];
    snprintf(command, sizeof command, "exec %s adapt hostile.png --no-predict --quiet -o - >/dev/null",
             program);
    for (int i = 0; i < PREVIEWS; i++) {
        char id[64];
        double begun = seconds();
        start(picture, "\"verb\": \"adapt\", \"options\": {\"no-predict\": true}, \"files\": [\"mask.png\"]",
              id);
        reply events = about(id, "/events"), mask = about(id, "/files/mask.png");
        served_in[i] = seconds() - begun;
        if (mask.status != 200) printf("no preview: %s\n", events.body);
        reply_free(&events);
        reply_free(&mask);
        begun = seconds();
        if (system(command) != 0) printf("no preview by the command line\n");
        run_in[i] = seconds() - begun;
    }
    print_times(name, "preview of 1 Mpixel, from the server", served_in);
    print_times(name, "the same, jali adapt", run_in);
}

static void upload_sample(const char *name, char id[64])
{
    char path[128];
    snprintf(path, sizeof path, "/api/v1/samples/%s.png", name);
    reply r = ask(&page, "GET", path, NULL),
          sent = ask_bytes(&page, "POST", "/api/v1/uploads", r.body, r.size);
    id_of(&sent, id);
    FILE *file = fopen("hostile.png", "wb");
    if (file) {
        fwrite(r.body, 1, r.size, file);
        fclose(file);
    }
    reply_free(&r);
    reply_free(&sent);
}

int main(int argc, char **argv)
{
    pthread_t thread[THREADS], slow[THREADS];
    char picture[64], again[64];
    if (argc < 2) return 2;
    requests = argc > 2 ? (int)strtol(argv[2], NULL, 10) : 10000;
    page = serve(argv[1], "");
    if (!page.port) return 1;
    static const char *const samples[] = {"mask", "tree", "lettering"};
    for (int i = 0; i < 3; i++) {
        upload_sample(samples[i], picture);
        time_previews(argv[1], samples[i], picture);
    }
    remove("hostile.png");
    static const char whole[] = "\"files\": [\"object.3mf\"]";
    start(picture, whole, job);
    reply events = about(job, "/events"), first = about(job, "/files/object.3mf");
    reply_free(&events);
    long memory = number_in("status", "VmRSS:"), threads = number_in("status", "Threads:");
    int open_files = files_open();
    double begun = seconds();
    for (int i = 0; i < THREADS; i++) {
        pthread_create(&slow[i], NULL, linger, NULL);
        pthread_create(&thread[i], NULL, attack, NULL);
    }
    start(picture, whole, again); // someone works on
    events = about(again, "/events");
    reply second = about(again, "/files/object.3mf");
    reply_free(&events);
    for (int i = 0; i < THREADS; i++) pthread_join(thread[i], NULL);
    double taken = seconds() - begun;
    for (int i = 0; i < THREADS; i++) pthread_join(slow[i], NULL);
    int wrong = 0;
    for (int i = 0; i < KINDS; i++) {
        printf("%-28s %5d refused as they should be, %d otherwise\n", kinds[i].what, as_wanted[i],
               otherwise[i]);
        wrong += otherwise[i];
    }
    reply kept = about(job, "/files/object.3mf");
    bool same = first.status == 200 && first.size == second.size && first.size == kept.size &&
                memcmp(first.body, second.body, first.size) == 0 &&
                memcmp(first.body, kept.body, first.size) == 0;
    printf("slow bodies cut off: %d of %d\n", slow_cut, THREADS);
    printf("%d requests in %.1f s; memory %ld KB before, %ld KB after; threads %ld and %ld; open files %d "
           "and %d\n",
           requests, taken, memory, number_in("status", "VmRSS:"), threads, number_in("status", "Threads:"),
           open_files, files_open());
    printf("the results before, meanwhile and after are %s\n", same ? "the same bytes" : "NOT the same");
    reply_free(&first);
    reply_free(&second);
    reply_free(&kept);
    int ended = stop_serving(&page, SIGTERM);
    return wrong || !same || slow_cut < THREADS || ended;
}
