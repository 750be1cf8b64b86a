// The files a job can be asked for: the command line's outputs under fixed names, and the layers of
// cli/layers.h.
#include "files.h"
#include "layers.h"
#include "values.h"

#define FIELD(field) BY_FIELD, offsetof(settings, field)

static const job_file files[] = {
    {"figures.json", "application/json", FIELD(json), NULL},
    {"report.html", "text/html; charset=utf-8", FIELD(report), NULL},
    {"bridges.json", "application/json", FIELD(bridges), NULL},
    {"render.png", "image/png", FIELD(render), NULL},
    {"stress.png", "image/png", FIELD(map), NULL},
    {"stress.ply", "application/octet-stream", FIELD(map), NULL},
    {"stress.vtu", "application/octet-stream", FIELD(map), NULL},
    {"displacement.png", "image/png", FIELD(moved_map), NULL},
    {"displacement.ply", "application/octet-stream", FIELD(moved_map), NULL},
    {"displacement.vtu", "application/octet-stream", FIELD(moved_map), NULL},
    {"levels.json", "application/json", FIELD(json), "read"},
    {"smallest.json", "application/json", FIELD(json), "smallest"},
    {"printer.json", "application/json", BY_SUFFIX, 0, "printer"},
    {"grey.png", "image/png", BY_SUFFIX, 0, "read"},
    {"mask.png", "image/png", BY_SUFFIX, 0, NULL},
    {"object.3mf", "model/3mf", BY_SUFFIX, 0, NULL},
    {"object.stl", "model/stl", BY_SUFFIX, 0, NULL},
    {"outline.svg", "image/svg+xml", BY_SUFFIX, 0, NULL},
    {"outline.dxf", "image/vnd.dxf", BY_SUFFIX, 0, NULL},
    {"input.png", "image/png", BY_LAYER, 0, NULL},
    {"bridges.png", "image/png", BY_LAYER, 0, NULL},
    {"conflicts.png", "image/png", BY_LAYER, 0, NULL},
    {"print.png", "image/png", BY_LAYER, 0, NULL},
    {"errors.png", "image/png", BY_LAYER, 0, NULL},
    {"lost.png", "image/png", BY_LAYER, 0, NULL},
    {"mesh.bin", "application/octet-stream", BY_LAYER, 0, NULL},
    {"stress.bin", "application/octet-stream", BY_LAYER, 0, NULL},
    {"displacement.bin", "application/octet-stream", BY_LAYER, 0, NULL},
    {"surface.bin", "application/octet-stream", BY_LAYER, 0, NULL},
    {0},
};

const job_file *job_files(void)
{
    return files;
}

const job_file *job_file_named(const char *name)
{
    for (const job_file *file = files; file->name; file++)
        if (strcmp(file->name, name) == 0) return file;
    return NULL;
}

bool ask_for_file(const job_file *file, const verb *v, settings *set, char sentence[SENTENCE_BYTES])
{
    const char **field = (const char **)((char *)set + file->offset);
    bool object = (v->groups & GROUP_PLATE) != 0; // else there are pictures alone
    bool makes = file->verb ? strcmp(file->verb, v->name) == 0 : (v->groups & GROUP_METHOD) != 0;
    if (!makes) return wrong(sentence, "jali %s does not make %s", v->name, file->name);
    switch (file->how) {
    case BY_SUFFIX:
        if (!strstr(v->suffixes, strrchr(file->name, '.')))
            return wrong(sentence, "jali %s does not make %s", v->name, file->name);
        set->output[set->output_count++] = file->name;
        return true;
    case BY_LAYER: set->layers |= UINT32_C(1) << layer_named(file->name); return true;
    default:
        if (!object && (field == &set->render || field == &set->map || field == &set->moved_map))
            return wrong(sentence, "jali %s does not make %s", v->name, file->name);
        if (*field) return wrong(sentence, "a run draws one of %s and %s", *field, file->name);
        *field = file->name;
        return true;
    }
}
