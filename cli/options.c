// A table of options and what reads it: `--name value`, `--name=value`, `-o value`, flags.
//
// Numbers are finite, inside the range of their option, and may carry its unit (12mm). The table's `offset`
// says which field of the settings an option fills.
#include "values.h"

#include <math.h>
#include <stdio.h>

#define FIELD(field) offsetof(settings, field)

// clang-format off
static const option options[] = {
    {"output", "FILE", OUTPUT, GROUP_FILES, 0, 0, 0, 0,
     "write this file (also -o; several may be given; - is stdout)"},
    {"force-overwrite", NULL, FLAG, GROUP_OVERWRITE, FIELD(force_overwrite), 0, 0, 0,
     "replace output files that exist"},
    {"json", "FILE", TEXT, GROUP_JSON, FIELD(json), 0, 0, 0, "write the figures as JSON (- is stdout)"},
    {"report", "FILE", TEXT, GROUP_REPORT, FIELD(report), 0, 0, 0, "write a report as one HTML file"},

    {"bridges", "FILE", TEXT, GROUP_REPORT, FIELD(bridges), 0, 0, 0,
     "write the bridges that were laid, as --edits takes them"},

    {"threshold", "0..255|auto|local", THRESHOLD, GROUP_PICTURE, 0, 0, 255, 0,
     "grey level from which a pixel is white; local follows uneven light (auto)"},
    {"window", "PX", WHOLE, GROUP_PICTURE, FIELD(make.threshold.window_px), 3, 4001, "px",
     "side of the neighbourhood of --threshold local (1/16 of the shorter side)"},
    {"contrast", "SHARE", NUMBER, GROUP_PICTURE, FIELD(make.threshold.contrast), 0, 1, 0,
     "of --threshold local: more counts only stronger edges (0.2)"},
    {"invert", NULL, FLAG, GROUP_PICTURE, FIELD(read.invert), 0, 0, 0, "swap black and white"},
    {"mirror", NULL, FLAG, GROUP_PICTURE, FIELD(read.mirror), 0, 0, 0, "swap left and right"},
    {"rotate", "0|90|180|270", ROTATE, GROUP_PICTURE, 0, 0, 270, 0, "turn clockwise (0)"},
    {"crop", "L,T,W,H", CROP, GROUP_PICTURE, 0, 0, 0, 0,
     "keep this part, in pixels from the upper left corner"},

    {"width", "MM", NUMBER, GROUP_SIZE, FIELD(make.place.width_mm), 0.01, 10000, "mm",
     "width of the picture (70)"},
    {"height", "MM", NUMBER, GROUP_SIZE, FIELD(make.place.height_mm), 0.01, 10000, "mm",
     "height of the picture; one size gives the other"},
    {"frame", "MM", NUMBER, GROUP_SIZE, FIELD(make.place.frame_mm), 0, 1000, "mm",
     "width of the solid frame, 0 = none (2)"},
    {"printer", "NAME|FILE", TEXT, GROUP_SIZE | GROUP_BOARD | GROUP_CALIBRATE, FIELD(printer), 0, 0, 0,
     "what prints it: phi-e, phi-s, phi-v, material (\"jali list printers\"; a profile, a slicer's configuration)"},
    {"phi-e", "MM", NUMBER, GROUP_SIZE, FIELD(phi_given_mm[0]), -10, 100, "mm",
     "how much wider a solid bar prints than drawn; negative for a laser's kerf (the printer's; 0.1)"},
    {"phi-s", "MM", NUMBER, GROUP_SIZE | GROUP_BOARD | GROUP_CALIBRATE, FIELD(phi_given_mm[1]), 0.001, 100, "mm",
     "narrowest solid that prints (the printer's; 0.3)"},
    {"phi-v", "MM", NUMBER, GROUP_SIZE | GROUP_BOARD | GROUP_CALIBRATE, FIELD(phi_given_mm[2]), 0.001, 100, "mm",
     "narrowest void that prints (the printer's; 0.5)"},
    {"pixel", "MM", NUMBER, GROUP_GRID | GROUP_BOARD, FIELD(make.place.pixel_mm), 0.0001, 100, "mm",
     "working pixel (of a picture: at least 8 a width, a whole number a phi-e / 2; of a board 0.05)"},
    {"grid", "N", WHOLE, GROUP_GRID, FIELD(make.place.grid), 2, 64, 0,
     "working pixels across the narrowest feature, at least; 4 is a quick preview (8)"},
    {"paper", NULL, FLAG, GROUP_GRID, FIELD(make.optimise.paper), 0, 0, 0,
     "the paper's own method: input pixels, square elements, its roundings"},

    {"epsilon", "MM", NUMBER, GROUP_METHOD, FIELD(make.optimise.epsilon_mm), 0, 1000, "mm",
     "length above which a thin tip counts as a feature (4)"},
    {"detail", "WEIGHT", NUMBER, GROUP_METHOD, FIELD(make.optimise.detail), 0, 100, "",
     "weight of fine detail against wrong pixels; 2 draws more of it, and wider (1)"},
    {"nudge", "ROUNDS", WHOLE, GROUP_METHOD, FIELD(make.nudge_rounds), 0, 100, 0,
     "move edges until the predicted print comes nearest to the picture, at most so many rounds; 3 is enough (0)"},
    {"kernels", "C,W,B", KERNELS, GROUP_METHOD, 0, 0, 0, 0,
     "set the elements' sizes in working pixels outright"},
    {"edits", "FILE", TEXT, GROUP_METHOD, FIELD(edits), 0, 0, 0,
     "bridges drawn by hand, places where none may run, regions to leave alone (docs/edits.md)"},
    {"no-predict", NULL, FLAG_OFF, GROUP_METHOD, FIELD(make.predict), 0, 0, 0,
     "do not say what the printer makes of it"},

    {"thickness", "MM", NUMBER, GROUP_PLATE | GROUP_BOARD, FIELD(thickness_mm), 0.01, 1000, "mm",
     "thickness of the plate (4), of a surface's wall or the board (2)"},
    {"corner", "MM", NUMBER, GROUP_PLATE, FIELD(make.carve.corner_radius_mm), 0, 1000, "mm",
     "radius of the plate's corners (0)"},
    {"hole", "MM", NUMBER, GROUP_PLATE, FIELD(make.carve.hole_diameter_mm), 0, 100, "mm",
     "diameter of a hole to hang it by (0: none)"},
    {"bridge-depth", "MM", NUMBER, GROUP_PLATE, FIELD(make.bridge_depth_mm), 0, 1000, "mm",
     "how deep bridges are, at the side that is not seen: z = 0, the inside of a surface (as the rest)"},
    {"deviation", "MM", NUMBER, GROUP_PLATE, FIELD(make.trace.deviation_mm), 0.0001, 10, "mm",
     "how far outlines may leave the smooth curve (0.01)"},

    {"surface", "SHAPE|FILE", TEXT, GROUP_SURFACE, FIELD(surface), 0, 0, 0,
     "what to carve: a shape such as vase:h=120 (\"jali list surfaces\") or a model file (a flat plate)"},
    {"place", "auto|project|wrap", PLACING, GROUP_SURFACE, 0, 0, 0, 0,
     "as seen by a camera, or laid on the surface, unrolled or flattened (auto: shapes are wrapped, models are not)"},
    {"at", "X,Y,Z", AT, GROUP_SURFACE, 0, 0, 0, 0,
     "the picture's centre lies behind this point, or next to it when wrapped (found)"},
    {"dir", "X,Y,Z", VECTOR, GROUP_SURFACE, FIELD(make.place.camera.direction), 0, 0, 0,
     "direction in which a projected picture is seen (where there is room, the front first)"},
    {"up", "X,Y,Z", VECTOR, GROUP_SURFACE, FIELD(make.place.camera.up), 0, 0, 0,
     "what is up in a picture on a model (0,0,1)"},
    {"camera", "from=X,Y,Z[,to=X,Y,Z][,fov=DEG]", CAMERA, GROUP_SURFACE, 0, 0, 0, 0,
     "a perspective: the eye, where it looks at, and the picture's width as an angle"},
    {"repeat", "N", WHOLE, GROUP_SURFACE, FIELD(make.repeat), 1, 1000, 0,
     "so many copies side by side; without a size they fill the way around (1)"},
    {"around", NULL, FLAG, GROUP_SURFACE, FIELD(make.around), 0, 0, 0,
     "all around, copy beside copy, no bar at the back; without a size of its own"},
    {"backing", "MM", NUMBER, GROUP_SURFACE, FIELD(make.backing_mm), 0, 1000, "mm",
     "a film inside that stays behind the voids of a surface (0: none)"},
    {"thinnest", "MM", NUMBER, GROUP_SURFACE, FIELD(wall.least_mm), 0.01, 1000, "mm",
     "the least a surface's wall may be where it cannot have its thickness (0.3)"},
    {"force", "N", NUMBER, GROUP_LOAD, FIELD(make.strengthen.analyse.load.force_n), -1e9, 1e9, "N",
     "press evenly against the outer side with so much in all"},
    {"pressure", "MPA", NUMBER, GROUP_LOAD, FIELD(make.strengthen.analyse.load.pressure_mpa), -1e6, 1e6, "MPa",
     "the same, as force by area"},
    {"weight", "TIMES", NUMBER, GROUP_LOAD, FIELD(make.strengthen.analyse.load.weight), 0, 1e6, "",
     "its own weight, times this"},
    {"gravity", "X,Y,Z", VECTOR, GROUP_LOAD, FIELD(make.strengthen.analyse.load.gravity), 0, 0, 0,
     "where weight pulls to (0,0,-1)"},
    {"push", "X,Y,Z,N", PUSH, GROUP_LOAD, 0, 0, 0, 0,
     "push with N newtons on the spot nearest to a point"},
    {"pinch", "N", NUMBER, GROUP_LOAD, FIELD(make.strengthen.analyse.load.pinch_n), -1e9, 1e9, "N",
     "squeeze it between two fingers"},
    {"pinch-axis", "X,Y,Z", VECTOR, GROUP_LOAD, FIELD(make.strengthen.analyse.load.pinch_axis), 0, 0, 0,
     "the line through the fingers (1,0,0)"},
    {"spot", "MM", NUMBER, GROUP_LOAD, FIELD(make.strengthen.analyse.load.spot_mm), 0.001, 1000, "mm",
     "radius of what is pushed or pinched (3)"},
    {"support", "picture|rim|base", SUPPORT, GROUP_LOAD, 0, 0, 0, 0,
     "what is held: the picture's boundary, a plate's outline, what an object stands on (picture)"},
    {"material", "NAME", MATERIAL, GROUP_LOAD, 0, 0, 0, 0,
     "what it is made of (\"jali list materials\"; the printer's; pla)"},
    {"limit", "MPA", NUMBER, GROUP_LOAD, FIELD(limit_mpa), 1e-6, 1e6, "MPa",
     "the largest stress to allow (the material's)"},
    {"across", "N", WHOLE, GROUP_LOAD, FIELD(make.strengthen.across), 1, 16, 0,
     "elements across the narrowest solid; 2 is a preview (4)"},
    {"map", "FILE", TEXT, GROUP_LOAD | GROUP_CALIBRATE, FIELD(map), 0, 0, 0,
     "draw the stress: .png, .ply (coloured) or .vtu (ParaView); of calibrate: what was measured, .png"},
    {"displacement-map", "FILE", TEXT, GROUP_LOAD, FIELD(moved_map), 0, 0, 0,
     "draw how far it gives way, likewise"},
    {"solver", "direct|petsc", SOLVER, GROUP_SOLVER, 0, 0, 0, 0,
     "solve here, or by the processes that mpirun has started (direct)"},
    {"reinforce", "best|paper|none", REINFORCE, GROUP_REINFORCE, 0, 0, 0, 0,
     "lay connectors until it holds: where they help most, by the paper's rule, or not at all (best)"},
    {"rounds", "N", WHOLE, GROUP_REINFORCE, FIELD(make.strengthen.reinforce.most_rounds), 1, 1000, 0,
     "of connectors, at most (16)"},
    {"longest", "MM", NUMBER, GROUP_REINFORCE, FIELD(make.strengthen.reinforce.longest_mm), 0.01, 10000, "mm",
     "the longest connector (a third of the picture's shorter side)"},
    {"no-structure", NULL, FLAG, GROUP_REINFORCE, FIELD(no_structure), 0, 0, 0,
     "leave the load out of it, all the same"},
    {"job", "FILE", TEXT, GROUP_JOB, FIELD(job), 0, 0, 0,
     "several pictures on one surface, as JSON, in place of PICTURE (docs/job.md)"},

    {"within", "MM", NUMBER, GROUP_BOARD | GROUP_CALIBRATE, FIELD(board.most_mm), 40, 200, "mm",
     "the longest side the board may have (200)"},

    {"measured", "LIST", TEXT, GROUP_CALIBRATE, FIELD(measured), 0, 0, 0,
     "widths instead of a table: KIND:DESIGNED=MEASURED,... such as solid:0.4=0.52,void:0.3=0"},

    {"dpi", "N", NUMBER, GROUP_CALIBRATE, FIELD(dpi), 10, 20000, 0,
     "the scan's pixels an inch: shrinkage counts as well (the board's own size is the scale)"},

    {"gcode", "FILE", TEXT, GROUP_WITNESS, FIELD(gcode), 0, 0, 0,
     "the print is what this G-code lays: its extrusions, with their widths"},
    {"filament", "MM", NUMBER, GROUP_WITNESS, FIELD(print.filament_mm), 0.1, 20, "mm",
     "diameter of the filament where the G-code says neither it nor widths (1.75)"},
    {"sl1", "FILE", TEXT, GROUP_WITNESS, FIELD(sl1), 0, 0, 0, "the print is what the layers of this SL1 file expose"},
    {"sl1-pixel", "MM", NUMBER, GROUP_WITNESS, FIELD(print.pixel_mm), 0.001, 1, "mm",
     "side of a pixel of those layers where the file does not say"},
    {"scan", "FILE", TEXT, GROUP_WITNESS | GROUP_CALIBRATE, FIELD(scan), 0, 0, 0,
     "the print, or the board, is what this scan or photograph shows: the whole plate and a little around it"},

    {"render", "FILE", TEXT, GROUP_RENDER, FIELD(render), 0, 0, 0, "draw the object as a PNG"},
    {"lamp", NULL, FLAG, GROUP_VIEW, FIELD(view.lamp), 0, 0, 0, "draw it at night, with a lamp inside"},
    {"view", "X,Y,Z", VECTOR, GROUP_VIEW, FIELD(view.view), 0, 0, 0,
     "draw it as seen in this direction (from the front, the right and above)"},
    {"size", "PX", WHOLE, GROUP_SIDE, FIELD(size_px), 16, 32768, "px", "side of the picture (1000)"},
    {"skip-intersections", NULL, FLAG, GROUP_CHECK, FIELD(skip_intersections), 0, 0, 0,
     "leave out the one costly test"},
    {"walls", NULL, FLAG, GROUP_CHECK, FIELD(walls), 0, 0, 0,
     "measure the thinnest wall and the narrowest gap as well"},

    {"least", "MM", NUMBER, GROUP_SMALLEST, FIELD(smallest.least_mm), 0.1, 10000, "mm", "the smallest width to try (10)"},
    {"most", "MM", NUMBER, GROUP_SMALLEST, FIELD(smallest.most_mm), 0.1, 10000, "mm", "the largest width to try (400)"},
    {"precision", "SHARE", NUMBER, GROUP_SMALLEST, FIELD(smallest.precision), 0.001, 1, "",
     "the answer is at most so much too large (0.03)"},
    {"speck", "PX", WHOLE, GROUP_SMALLEST, FIELD(smallest.least_px), 1, 10000, "px",
     "parts smaller and lines shorter than so many of the picture's pixels are no details (8)"},

    {"port", "N", WHOLE, GROUP_SERVE, FIELD(port), 0, 65535, 0, "port of the page; 0 takes one that is free (7170)"},
    {"jobs", "N", WHOLE, GROUP_SERVE, FIELD(jobs), 1, 64, 0, "so many jobs at one time, the others wait (all)"},
    {"job-memory", "MB", NUMBER, GROUP_SERVE, FIELD(job_memory_mb), 16, 1e6, "MB", "the most a job may hold (2000)"},
    {"job-time", "S", NUMBER, GROUP_SERVE, FIELD(job_seconds), 0.1, 1e6, "s", "the longest a job may take (600)"},

    {"threads", "N", WHOLE, GROUP_RUN, FIELD(context.threads), 1, 1024, 0,
     "threads to use; never changes a result (all)"},
    {"max-memory", "MB", NUMBER, GROUP_RUN, FIELD(max_memory_mb), 1, 1e9, "MB",
     "give up rather than hold more"},
    {"timeout", "S", NUMBER, GROUP_RUN, FIELD(context.timeout_seconds), 0.001, 1e9, "s",
     "give up after this long"},
    {"progress", "auto|plain|none", PROGRESS, GROUP_RUN, 0, 0, 0, 0,
     "show it on a terminal, as lines, or not at all (auto)"},
    {"quiet", NULL, FLAG, GROUP_RUN, FIELD(quiet), 0, 0, 0, "say nothing but errors (also -q)"},
    {"help", NULL, FLAG, GROUP_RUN, FIELD(help), 0, 0, 0, "these lines (also -h)"},
};
// clang-format on

enum { OPTION_COUNT = sizeof options / sizeof *options };

settings default_settings(void)
{
    settings set = {
        .read = jali_read_defaults(),
        .make = jali_defaults(),
        .wall = jali_shell_defaults(),
        .context = jali_context_defaults(),
        .size_px = 1000,
        .print = jali_print_defaults(),
        .view = jali_render_defaults(),
        .phi_given_mm = {NAN, NAN, NAN},
        .board = jali_board_defaults(),
        .smallest = jali_smallest_defaults(),
        .port = 7170,
        .job_memory_mb = 2000,
        .job_seconds = 600,
    };
    set.print.pixel_mm = 0;
    set.make.place.width_mm = 0; // 70 stands unless a height is given
    return set;
}

const option *option_list(int32_t *count)
{
    *count = OPTION_COUNT;
    return options;
}

static const option *find_option(const char *name, size_t length)
{
    for (int32_t i = 0; i < OPTION_COUNT; i++)
        if (strlen(options[i].name) == length && strncmp(options[i].name, name, length) == 0)
            return &options[i];
    return NULL;
}

static bool unknown_option(const verb *v, const char *name, size_t length, char *sentence)
{
    const char *names[OPTION_COUNT];
    char typed[64];
    int32_t count = 0;
    for (int32_t i = 0; i < OPTION_COUNT; i++)
        if (options[i].group & v->groups) names[count++] = options[i].name;
    snprintf(typed, sizeof typed, "%.*s", (int)MIN(length, sizeof typed - 1), name);
    const char *near = nearest_name(typed, names, count);
    if (near) return wrong(sentence, "there is no option --%s; did you mean --%s?", typed, near);
    return wrong(sentence, "there is no option --%s; \"jali %s --help\" lists those there are", typed,
                 v->name);
}

// One option at argv[*i]; leaves *i on its last argument.
static bool parse_one(const verb *v, int argc, char **argv, int *i, settings *set, char *sentence)
{
    const char *word = argv[*i] + 2, *text = NULL;
    if (argv[*i][1] != '-') { // the few short ones
        if (argv[*i][1] == 0 || argv[*i][2] != 0)
            return wrong(sentence, "there is no option %.40s", argv[*i]);
        word = argv[*i][1] == 'o'   ? "output"
               : argv[*i][1] == 'q' ? "quiet"
               : argv[*i][1] == 'h' ? "help"
                                    : argv[*i] + 1;
    }
    const char *equals = strchr(word, '=');
    size_t length = equals ? (size_t)(equals - word) : strlen(word);
    const option *o = find_option(word, length);
    if (!o) return unknown_option(v, word, length, sentence);
    if (!(o->group & v->groups)) return wrong(sentence, "--%s is not an option of jali %s", o->name, v->name);
    if (!o->value && equals) return wrong(sentence, "--%s takes no value", o->name);
    if (o->value) {
        if (!equals && *i + 1 >= argc) return wrong(sentence, "--%s needs a value (%s)", o->name, o->value);
        text = equals ? equals + 1 : argv[++*i];
    }
    return set_option(o, text, set, sentence);
}

static bool set_operand(const verb *v, const char *text, settings *set, char *sentence)
{
    if (!v->operand) return wrong(sentence, "jali %s takes no \"%.60s\"", v->name, text);
    if (set->operand)
        return wrong(sentence, "jali %s takes one %s; there are two, \"%.60s\" and \"%.60s\"", v->name,
                     v->operand, set->operand, text);
    set->operand = text;
    return true;
}

// What follows from options together.
void settle_options(settings *set)
{
    jali_place_options *place = &set->make.place;
    bool all_around = (set->make.repeat > 0 || set->make.around) &&
                      place->placing != JALI_PLACE_PROJECT; // then that gives the size
    if (place->width_mm == 0 && place->height_mm == 0 && place->camera.fov_deg == 0 && !all_around)
        place->width_mm = jali_place_defaults().width_mm;
    const jali_load *load = &set->make.strengthen.analyse.load;
    set->make.structure =
        !set->no_structure && (load->force_n != 0 || load->pressure_mpa != 0 || load->weight != 0 ||
                               load->push_n != 0 || load->pinch_n != 0);
    if (set->thickness_mm > 0) set->make.carve.thickness_mm = set->wall.thickness_mm = set->thickness_mm;
}

bool set_option_named(const char *name, const char *text, uint32_t groups, settings *set,
                      char sentence[SENTENCE_BYTES])
{
    const option *o = find_option(name, strlen(name));
    if (!o || !(o->group & groups)) return wrong(sentence, "there is no option \"%.40s\" here", name);
    if (!o->value && strcmp(text, "true") && strcmp(text, "false"))
        return wrong(sentence, "\"%s\" takes true or false", name);
    if (!o->value && strcmp(text, "false") == 0) return true;
    return set_option(o, text, set, sentence);
}

bool parse_options(const verb *v, int argc, char **argv, settings *set, char sentence[SENTENCE_BYTES])
{
    bool options_ended = false;
    for (int i = 0; i < argc; i++) {
        bool is_option = !options_ended && argv[i][0] == '-' && argv[i][1] != 0;
        if (is_option && strcmp(argv[i], "--") == 0)
            options_ended = true;
        else if (is_option ? !parse_one(v, argc, argv, &i, set, sentence)
                           : !set_operand(v, argv[i], set, sentence))
            return false;
    }
    if (set->help) return true;
    if (set->job && set->operand)
        return wrong(sentence, "--job names the pictures; \"%.60s\" is one too many", set->operand);
    if (v->operand && !set->operand && !set->job && !set->measured && !(v->groups & NEEDS_NO_OPERAND) &&
        !(set->scan && v->groups & GROUP_CALIBRATE))
        return wrong(sentence, "jali %s needs a %s", v->name, v->operand);
    if (*v->suffixes && !(v->groups & WRITES_NOTHING_TOO) && set->output_count == 0)
        return wrong(sentence, "jali %s needs an output file: -o NAME%.4s", v->name, v->suffixes);
    settle_options(set);
    set->context.max_memory_bytes = (uint64_t)(set->max_memory_mb * 1e6);
    return true;
}

void print_options(const verb *v)
{
    for (int32_t i = 0; i < OPTION_COUNT; i++) {
        const option *o = &options[i];
        char head[64];
        if (!(o->group & v->groups)) continue;
        snprintf(head, sizeof head, "--%s %s", o->name, o->value ? o->value : "");
        printf("  %-30s %s\n", head, o->help);
    }
}
