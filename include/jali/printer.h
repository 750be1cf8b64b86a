// Printer: a profile of a machine, how much wider, narrower and rounder things come out of it than drawn.
//
// A profile is a JSON file (docs/printer.md). Some are built in; users keep their own in a folder.
#ifndef JALI_PRINTER_H
#define JALI_PRINTER_H

#include <jali/analyse.h>
#include <jali/bytes.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum jali_process {
    JALI_PROCESS_NONE, // the profile does not say
    JALI_PROCESS_FDM,
    JALI_PROCESS_SLA,
    JALI_PROCESS_SLS,
    JALI_PROCESS_LASER,
    JALI_PROCESS_CUTTER,
    JALI_PROCESSES
} jali_process;

/// "fdm", "sla", ...; "" for none.
JALI_API const char *jali_process_name(jali_process process);

enum { JALI_NAME_BYTES = 64, JALI_SOURCE_BYTES = 240 }; // of texts in a profile, their end mark included

/// A number and where it comes from.
typedef struct jali_figure {
    double value;
    char source[JALI_SOURCE_BYTES]; // a sentence; "" = the profile does not say, and value is 0
} jali_figure;

/// A plain value: copy it, there is nothing to free. {0} is valid and says nothing.
typedef struct jali_printer {
    char name[JALI_NAME_BYTES];
    char what[JALI_SOURCE_BYTES]; // one line for people
    jali_process process;
    jali_figure tool_mm;               // nozzle, spot, pixel, kerf or blade, > 0
    jali_figure layer_mm;              // > 0
    jali_figure bed_mm[3];             // room for the object along x, y, z, > 0; z: sheets, their thickness
    jali_figure phi_e_solid_mm;        // how much wider a solid bar comes out than drawn; < 0: a laser's kerf
    jali_figure phi_e_void_mm;         // how much narrower a void bar comes out than drawn; < 0: wider
    jali_figure phi_e_solid_spread_mm; // standard deviation of the former over the bars, >= 0
    jali_figure phi_e_void_spread_mm;  // of the latter
    jali_figure phi_s_mm;              // narrowest solid that prints, > 0
    jali_figure phi_v_mm;              // narrowest void that prints, > 0
    jali_figure hole_mm2;  // a round hole d wide comes out phi_e_void_mm + hole_mm2 / d narrower, >= 0
    jali_figure corner_mm; // radius to which sharp corners come out rounded, >= 0
    char material[JALI_NAME_BYTES]; // one that is built in, unless the next four say more; "" = not said
    jali_figure e_mpa, nu, density_g_cm3, limit_mpa; // the material's own figures, all four or none
} jali_printer;

/// The mean of the two: the paper's phi_e.
JALI_API double jali_printer_phi_e_mm(const jali_printer *printer);

/// What it prints with; false, and the first of the built-in materials, when the profile does not say.
///   out    material   its name and source point into the profile, which must outlive it
JALI_API bool jali_printer_material(const jali_printer *printer, jali_material *material);

/// Names of the profiles that are built in, in alphabetical order.
JALI_API const char *const *jali_printer_names(int32_t *count);

/// Does jali_printer_find take this for a file's name? So it does when it has a slash or ends in .json, .ini
/// or .gcode.
JALI_API bool jali_printer_is_file(const char *name);

/// Find a profile: a file (jali_printer_is_file), else NAME.json in the user's
/// folder, else one that is built in.
///   in     folder    of the user's own profiles; NULL or one that is not there: none
///   fails  JALI_BAD_VALUE (no such name; the nearest one is named), and as jali_printer_read
JALI_API jali_status jali_printer_find(jali_context *ctx, const char *name, const char *folder,
                                       jali_printer *printer);

/// Read a profile of any kind that is known by its content: ours, a PrusaSlicer configuration, an Orca or
/// Bambu Studio profile (docs/printer.md). What ours inherits is looked up as by jali_printer_find, files
/// from the folder of the one that names them.
///   in     name      of the file, for sentences, for files it inherits, and for a profile without a name
///   fails  JALI_BAD_INPUT (which key of which file, what is accepted; a circle of inheritance; a figure that
///          every profile needs is missing), JALI_IO, JALI_NO_MEMORY
JALI_API jali_status jali_printer_read(jali_context *ctx, const uint8_t *bytes, size_t size, const char *name,
                                       const char *folder, jali_printer *printer);

/// Write a profile that inherits nothing: what it says and where from, the same bytes for the same profile.
///   out    json      appended
///   fails  JALI_BAD_VALUE (a figure out of range: what jali_printer_read would refuse), JALI_NO_MEMORY
JALI_API jali_status jali_printer_write(jali_context *ctx, const jali_printer *printer, jali_bytes *json);

#ifdef __cplusplus
}
#endif
#endif
