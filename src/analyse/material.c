// What walls are made of.
//
// Printed and sheet materials are not the same in all directions; the figures are the lower end of those
// given for a direction within the wall. The limit of PLA is the paper's (section 5), a fifth of its tensile
// strength: printed layers part at less than the bulk breaks at, and loads last. The other limits keep that
// fifth; steel has the usual 1.5 against yield. Sources: Heliyon 9 (2023) e15023, table 6 (PLA, PETG, ABS,
// PA12); Formlabs' data sheet of Clear resin, post-cured; Wood
//          Handbook (Forest Products Laboratory, FPL-GTR-282), chapter 12, and EN 12369-2 (plywood), EN 622-5
//          (MDF, 6 to 9 mm); ISO 7823-1 (cast acrylic); EN 1993-1-1, table 3.1 (steel S235).
#include <jali/analyse.h>

#include <strings.h>

static const jali_material materials[] = {
    {"pla", 3000, 0.36, 1.24, 10, "Heliyon 9 (2023) e15023; limit: the paper"},
    {"petg", 2010, 0.38, 1.27, 7.5, "Heliyon 9 (2023) e15023; a fifth of 38 MPa"},
    {"abs", 1790, 0.37, 1.04, 7, "Heliyon 9 (2023) e15023; a fifth of 35 MPa"},
    {"pa12", 1500, 0.39, 0.95, 8.5, "Heliyon 9 (2023) e15023 (SLS); a fifth of 43 MPa"},
    {"resin", 2800, 0.38, 1.18, 13, "Formlabs Clear, post-cured; a fifth of 65 MPa"},
    {"plywood", 8000, 0.2, 0.68, 8, "birch, the mean of both directions: EN 12369-2; a fifth of 40 MPa"},
    {"mdf", 2700, 0.25, 0.75, 4.5, "EN 622-5, 6 to 9 mm; a fifth of 23 MPa"},
    {"acrylic", 3000, 0.37, 1.19, 14, "ISO 7823-1, cast; a fifth of 70 MPa"},
    {"steel", 210000, 0.3, 7.85, 157, "S235, EN 1993-1-1; yield over 1.5"},
};

enum { MATERIAL_COUNT = sizeof materials / sizeof *materials };

const jali_material *jali_material_list(int32_t *count)
{
    *count = MATERIAL_COUNT;
    return materials;
}

const jali_material *jali_material_find(const char *name)
{
    for (int32_t i = 0; i < MATERIAL_COUNT; i++)
        if (strcasecmp(materials[i].name, name) == 0) return &materials[i];
    return NULL;
}
