// The command line's own types: what the user asked for, and the verbs.
#ifndef CLI_CLI_H
#define CLI_CLI_H

#include <jali/jali.h>
#include "base/base.h"

enum { MOST_OUTPUTS = 8 };

typedef enum exit_code {
    EXIT_DONE = 0,     // done, every promise kept
    EXIT_FAILED = 1,   // the system or a question without an answer
    EXIT_USAGE = 2,    // the command line itself
    EXIT_BROKEN = 3,   // done, but a promise is not kept; it is said which
    EXIT_REJECTED = 4, // the input is no good
    EXIT_LIMIT = 5,    // a limit on memory or time was reached
    EXIT_INTERRUPTED = 130
} exit_code;

typedef enum progress_kind { PROGRESS_AUTO, PROGRESS_PLAIN, PROGRESS_NONE } progress_kind;

/// Everything the options can say, as the structs of the stages. One struct serves all verbs.
typedef struct settings {
    const char *operand; // PICTURE, MODEL, NAME or KIND
    const char *output[MOST_OUTPUTS];
    int32_t output_count;
    const char *json, *report, *render; // files
    const char *edits;                  // file of what was laid down by hand
    const char *bridges;                // where the bridges found are written, as such edits
    const char *map, *moved_map;        // stress and displacement: .png, .ply, .vtu
    uint32_t layers;                    // bit i: layer i of layers.h as well, under its own name
    double limit_mpa;                   // 0 = the material's
    bool no_structure;
    jali_read_options read;
    jali_options make;             // of all stages
    const char *printer;           // name or file of a profile; NULL = none
    double phi_given_mm[3];        // --phi-e, -s, -v as given; NaN: the printer's
    const jali_material *material; // as given; NULL: the printer's
    const char *surface;           // what to carve, as jali_surface_make takes it; NULL = a plate
    jali_shell_options wall;       // of a surface
    double thickness_mm;           // of plate or wall; 0 = as usual for either
    const char *job;               // file with the pictures of one surface
    int32_t size_px;               // of a sample or a render
    jali_render_options view;      // of a render
    jali_board_options board;
    jali_smallest_options smallest;
    const char *measured;           // widths typed in
    double dpi;                     // of a scan; 0 = not said
    bool skip_intersections, walls; // of check
    const char *gcode, *sl1, *scan; // of compare: one of them; calibrate has a scan, too
    jali_print_options print;       // likewise; its pixel 0 = as the archive says
    jali_context_options context;
    double max_memory_mb;
    int32_t port; // of the page; 0 = any that is free
    int32_t jobs; // at one time; 0 = one a processor
    double job_memory_mb, job_seconds;
    int32_t progress; // progress_kind
    bool petsc;       // the structure is solved by several processes
    bool quiet, force_overwrite, help;
} settings;

/// Which options a verb takes; an option belongs to one group.
typedef enum option_group {
    GROUP_FILES = 1, // -o
    GROUP_JSON = 2,
    GROUP_REPORT = 4,
    GROUP_OVERWRITE = 8,
    GROUP_PICTURE = 16, // reading and thresholding
    GROUP_SIZE = 32,    // size on the surface, printer
    GROUP_METHOD = 64,  // the image method
    GROUP_PLATE = 128,  // the solid
    GROUP_CHECK = 512,
    GROUP_RUN = 1024, // every verb
    GROUP_SURFACE = 2048,
    GROUP_JOB = 4096,
    GROUP_RENDER = 8192, // a render beside other files
    GROUP_VIEW = 16384,  // what a render shows
    GROUP_SIDE = 32768,  // of a square picture
    GROUP_LOAD = 65536,  // what the object bears, its maps
    GROUP_REINFORCE = 131072,
    GROUP_SOLVER = 262144,
    GROUP_BOARD = 524288,
    GROUP_CALIBRATE = 1048576,
    GROUP_WITNESS = 1 << 22, // a printed result to compare with
    GROUP_SERVE = 1 << 23,
    GROUP_SMALLEST = 1 << 24,
    GROUP_GRID = 1 << 25,         // working pixels
    NEEDS_NO_OPERAND = 1 << 29,   // no options either: the operand may be left out
    WRITES_NOTHING_TOO = 1 << 30, // no options: what is to be written, -o, may be left out
} option_group;

typedef struct verb {
    const char *name;
    const char *operand;  // how the operand is called; NULL = none
    const char *what;     // one line
    uint32_t groups;      // of options it takes
    const char *suffixes; // of output files, such as ".png"; "" = none
    jali_status (*run)(jali_context *ctx, const settings *set);
} verb;

const verb *verb_list(int32_t *count);

jali_status run_sample(jali_context *ctx, const settings *set);
jali_status list_printers(jali_context *ctx);
jali_status run_list(jali_context *ctx, const settings *set);
jali_status run_adapt(jali_context *ctx, const settings *set);
jali_status run_carve(jali_context *ctx, const settings *set);
jali_status run_analyse(jali_context *ctx, const settings *set);
jali_status run_check(jali_context *ctx, const settings *set);
jali_status run_compare(jali_context *ctx, const settings *set);
jali_status run_render(jali_context *ctx, const settings *set);
jali_status run_calibrate(jali_context *ctx, const settings *set);
jali_status run_board(jali_context *ctx, const settings *set);
jali_status run_predict(jali_context *ctx, const settings *set);
jali_status run_serve(jali_context *ctx, const settings *set);
jali_status run_place(jali_context *ctx, const settings *set);
jali_status run_read(jali_context *ctx, const settings *set);
jali_status run_smallest(jali_context *ctx, const settings *set);
jali_status run_printer(jali_context *ctx, const settings *set);

/// Draw a mesh as the settings say, as a PNG; appended.
jali_status render_png(jali_context *ctx, const jali_mesh *mesh, const jali_render_options *view,
                       int32_t size_px, jali_bytes *png);

/// Where the user's own printers are: $XDG_CONFIG_HOME/jali/printers. Appended with an end mark; nothing when
/// neither that nor a home is known.
jali_status printers_folder(jali_context *ctx, jali_bytes *folder);

/// Hand over each printer there is: those that are built in, then the user's own by name.
///   in     see   folder: NULL of a built-in one; printer: NULL when `file` cannot be read, and the context
///   says why
jali_status each_printer(jali_context *ctx,
                         void (*see)(void *user, const char *folder, const char *file,
                                     const jali_printer *printer),
                         void *user);

/// Read set->printer, and fill in what follows: the three phi and the material, where none were given
/// outright. A material's texts may lie in set->make.printer: copies of the settings must not outlive them.
///   fails  as jali_printer_find
jali_status settle_printer(jali_context *ctx, settings *set);

/// The last part of a path, for people.
const char *name_of(const char *path);

/// The picture the user named, an SVG too where librsvg is at hand.
jali_status load_picture(jali_context *ctx, const settings *set, jali_picture *picture);

/// What a run made: one object, and what was found of each of its pictures. {0} is valid and empty.
typedef struct made {
    int32_t count;
    settings *set;         // [count] one a picture
    jali_picture *picture; // [count]
    jali_edits *edits;     // [count], in pixels of the picture
    jali_result *result;   // [count]
    jali_object object;    // a plate too; empty when only pictures were made
} made;

/// Does every picture bear its load?
bool sound_of(const made *m);

/// The pictures of one surface, from a file. {0} is valid and empty.
typedef struct job {
    int32_t count;
    settings *each; // [count]
    void *root;     // the parsed file: settings point into it
    char **text;    // [text_count] and into these
    size_t text_count, text_capacity;
} job;

/// Read set->job; its "surface" and its wall go to `set`, each picture gets a copy with options of its own.
///   fails  JALI_IO, JALI_BAD_INPUT (which key of which picture), JALI_NO_MEMORY
jali_status load_job(jali_context *ctx, settings *set, job *j);
void job_free(jali_context *ctx, job *j);

/// What a run found, as JSON (docs/json.md); appended, with a line end.
jali_status figures_json(jali_context *ctx, const made *m, jali_bytes *json);

/// The same for people: one HTML file with its pictures inside.
jali_status report_html(jali_context *ctx, const made *m, jali_bytes *html);

#ifdef JALI_HAVE_RSVG
bool looks_like_svg(const uint8_t *bytes, size_t size);
/// Draw an SVG in grey on white, as the bytes of a PGM file.
///   in     longer_px   of the longer side
jali_status draw_svg(jali_context *ctx, const uint8_t *bytes, size_t size, const char *name,
                     int32_t longer_px, jali_bytes *pgm);
#endif

/// Words for people, on stderr, unless --quiet.
void say(const settings *set, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// What the program ends with after this.
exit_code exit_code_of(jali_status status);

/// Run a verb in a context made from the settings: signals, progress, exit code.
///   in     refusal   what is wrong with the settings, and then nothing is run; NULL = nothing
exit_code run_verb(const verb *v, settings *set, const char *refusal);

#endif
