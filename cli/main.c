// jali: pictures carved through surfaces. One verb a job; `jali --help` lists them.
//
// Data go to stdout, words to stderr. The exit codes are in cli.h.
#include "options.h"
#include "outputs.h"
#include "processes.h"
#ifdef JALI_HAVE_SERVER
#include "worker.h"
#endif

#include <dlfcn.h>
#include <malloc.h>
#include <stdio.h>

enum {
    IMAGE = GROUP_PICTURE | GROUP_SIZE | GROUP_GRID | GROUP_METHOD,
    OUTPUT_AND_RUN = GROUP_FILES | GROUP_OVERWRITE | GROUP_RUN,
};

static const verb verbs[] = {
    {"carve", "PICTURE", "carve a picture through a plate or a surface, ready to print",
     IMAGE | GROUP_PLATE | GROUP_SURFACE | GROUP_JOB | GROUP_JSON | GROUP_REPORT | GROUP_RENDER | GROUP_VIEW |
         GROUP_SIDE | GROUP_LOAD | GROUP_REINFORCE | OUTPUT_AND_RUN,
     ".3mf.stl.svg.dxf.png", run_carve},
    {"analyse", "PICTURE|MODEL",
     "what a load does to a carved picture, or a plate, as it is: stress and displacement",
     IMAGE | GROUP_PLATE | GROUP_SURFACE | GROUP_JSON | GROUP_REPORT | GROUP_LOAD | GROUP_SOLVER |
         GROUP_OVERWRITE | GROUP_RUN,
     "", run_analyse},
    {"adapt", "PICTURE", "make the picture printable, and stop there",
     IMAGE | GROUP_SURFACE | GROUP_JSON | GROUP_REPORT | OUTPUT_AND_RUN, ".png", run_adapt},
    {"read", "PICTURE", "the picture in grey as the others see it: cropped, turned; and its grey levels",
     GROUP_PICTURE | GROUP_JSON | OUTPUT_AND_RUN | WRITES_NOTHING_TOO, ".png", run_read},
    {"place", "PICTURE", "put the picture on the printer's working grid, nothing else changed",
     GROUP_PICTURE | GROUP_SIZE | GROUP_GRID | OUTPUT_AND_RUN, ".png", run_place},
    {"predict", "PICTURE|MASK",
     "what the printer would make of a picture as it is: how much of it is wrong, and where",
     GROUP_PICTURE | GROUP_SIZE | GROUP_JSON | OUTPUT_AND_RUN | WRITES_NOTHING_TOO, ".png", run_predict},
    {"smallest", "PICTURE", "the smallest size at which nothing of the picture is lost",
     (IMAGE & ~GROUP_METHOD) | GROUP_SMALLEST | GROUP_JSON | GROUP_OVERWRITE | GROUP_RUN, "", run_smallest},
    {"compare", "PICTURE", "how far a print is from the picture: by the slicer's output, or by a scan",
     GROUP_PICTURE | GROUP_SIZE | GROUP_WITNESS | GROUP_JSON | OUTPUT_AND_RUN | WRITES_NOTHING_TOO, ".png",
     run_compare},
    {"check", "MODEL", "is a model a solid: closed, manifold, outward, nowhere through itself",
     GROUP_CHECK | GROUP_JSON | GROUP_OVERWRITE | GROUP_RUN, "", run_check},
    {"render", "MODEL", "draw a model, by day or with a lamp inside",
     GROUP_VIEW | GROUP_SIDE | OUTPUT_AND_RUN, ".png", run_render},
    {"sample", "NAME", "draw one of the built-in pictures", GROUP_SIDE | OUTPUT_AND_RUN, ".png", run_sample},
    {"board", NULL, "the reference board, from which a printer's figures are measured",
     GROUP_BOARD | GROUP_RENDER | GROUP_VIEW | GROUP_SIDE | OUTPUT_AND_RUN, ".3mf.stl.svg.dxf.png",
     run_board},
    {"printer", "NAME|FILE",
     "a printer's profile in full: what it inherits, what was found in a slicer's configuration",
     OUTPUT_AND_RUN, ".json", run_printer},
    {"calibrate", "WIDTHS", "a printer's profile from what was measured on a printed board",
     GROUP_CALIBRATE | GROUP_JSON | OUTPUT_AND_RUN, ".json", run_calibrate},
#ifdef JALI_HAVE_SERVER
    {"serve", "PICTURE", "a page for all of this, in the browser of this machine",
     GROUP_SERVE | GROUP_RUN | NEEDS_NO_OPERAND, "", run_serve},
#endif
    {"list", "KIND", "list what is built in: samples, surfaces, materials, printers", GROUP_RUN, "",
     run_list},
};

enum { VERB_COUNT = sizeof verbs / sizeof *verbs };

const verb *verb_list(int32_t *count)
{
    *count = VERB_COUNT;
    return verbs;
}

static int print_help(void)
{
    printf("jali carves a black and white picture through a plate or a vessel, ready to print.\n\n");
    for (int32_t i = 0; i < VERB_COUNT; i++) {
        char head[64];
        bool optional = verbs[i].groups & NEEDS_NO_OPERAND;
        snprintf(head, sizeof head, "jali %s %s%s%s", verbs[i].name, optional ? "[" : "",
                 verbs[i].operand ? verbs[i].operand : "", optional ? "]" : "");
        printf("  %-26s %s\n", head, verbs[i].what);
    }
    printf("\n\"jali VERB --help\" lists the options of a verb. Pictures are PNG, JPEG, WebP, PBM, PGM, PPM"
#ifdef JALI_HAVE_RSVG
           ", SVG"
#endif
           ";\n- is stdin or stdout. Exit: 0 done, 1 failed, 2 usage, 3 a promise is not kept, 4 input\n"
           "rejected, 5 a limit was reached, 130 interrupted.\n");
    return EXIT_DONE;
}

static int print_verb_help(const verb *v)
{
    bool optional = v->groups & WRITES_NOTHING_TOO;
    bool alone = v->groups & NEEDS_NO_OPERAND;
    printf("jali %s%s%s%s", v->name,
           alone        ? " ["
           : v->operand ? " "
                        : "",
           v->operand ? v->operand : "", alone ? "]" : "");
    if (*v->suffixes) printf(" %s-o NAME%.4s%s", optional ? "[" : "", v->suffixes, optional ? "]" : "");
    printf(": %s\n\n", v->what);
    print_options(v);
    return EXIT_DONE;
}

static int refuse(const char *sentence)
{
    fprintf(stderr, "jali: %s\n", sentence);
    return EXIT_USAGE;
}

static int unknown_verb(const char *typed)
{
    const char *names[VERB_COUNT];
    char sentence[SENTENCE_BYTES];
    for (int32_t i = 0; i < VERB_COUNT; i++) names[i] = verbs[i].name;
    const char *near = nearest_name(typed, names, VERB_COUNT);
    snprintf(sentence, sizeof sentence,
             near ? "there is no \"jali %.40s\"; did you mean \"jali %s\"?"
                  : "there is no \"jali %.40s\"; \"jali --help\" lists what there is",
             typed, near);
    return refuse(sentence);
}

// OpenBLAS starts threads as it is loaded, which spin for 0.1 s beside ours and are of no use: it is called
// from our own threads, one to each call. (Its variant without threads is not safe to call from several: 12
// of 80 runs of test_analyse failed with Debian's 0.3.21.) Another BLAS has no such function.
static void end_threads_of_blas(void)
{
    int (*end_threads)(void) = NULL;
    void *found = dlsym(RTLD_DEFAULT, "blas_thread_shutdown_");
    memcpy(&end_threads, &found, sizeof end_threads); // ISO C has no conversion between the two
    if (end_threads) (void)end_threads();
}

int main(int argc, char **argv)
{
    end_threads_of_blas();
    // Bitmaps of some MB come and go: keep their pages instead of asking the kernel for cleared ones each
    // time.
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    char sentence[SENTENCE_BYTES];
    settings set = default_settings();
#ifdef JALI_HAVE_SERVER
    if (argc > 1 && strcmp(argv[1], "work") == 0) return run_worker(argc, argv);
#endif
    if (argc < 2) return refuse("what shall be done? \"jali --help\" lists what there is");
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0)
        return print_help();
    if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0) {
        printf("jali %s\n", jali_version());
        return EXIT_DONE;
    }
    for (int32_t i = 0; i < VERB_COUNT; i++) {
        if (strcmp(argv[1], verbs[i].name) != 0) continue;
        if (!right_program(&verbs[i], argc, argv, sentence)) return refuse(sentence);
        bool understood = parse_options(&verbs[i], argc - 2, argv + 2, &set, sentence);
        if (understood && set.help) return print_verb_help(&verbs[i]);
        understood = understood && check_outputs(&verbs[i], &set, sentence);
        return (int)run_verb(&verbs[i], &set, understood ? NULL : sentence);
    }
    return unknown_verb(argv[1]);
}
