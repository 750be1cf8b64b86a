// A sheet and what it bears, for other programs: PLY with colours (Blender, MeshLab), VTU with fields
// (ParaView).
//
// Both are little endian, as is every machine this runs on; the same analysis gives the same bytes.
// Checked: tests/test_map.c reads them back; meshio in make judge.
#include <jali/map.h>

#include "base/bytes.h"

#include <math.h>
#include <stdio.h>

static jali_status append_float(jali_context *ctx, jali_bytes *bytes, double value)
{
    float f = (float)value;
    return bytes_append(ctx, bytes, &f, sizeof f);
}

jali_status jali_map_ply(jali_context *ctx, const jali_sheet *sheet, const jali_analysis *a,
                         const jali_map_options *given, jali_bytes *ply)
{
    jali_status status;
    jali_map_options opt = given ? *given : jali_map_defaults();
    double top = opt.top > 0 ? opt.top : opt.limit;
    for (int32_t i = 0; i < a->node_count && opt.top == 0; i++)
        top = fmax(top, jali_map_value(a, opt.quantity, i));
    TRY(bytes_print(
        ctx, ply,
        "ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float "
        "y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "property float stress_mpa\nproperty float displacement_mm\nelement face %d\nproperty list "
        "uchar int vertex_indices\nend_header\n",
        sheet->node_count, sheet->triangle_count));
    for (int32_t i = 0; i < sheet->node_count; i++) {
        uint8_t rgb[3];
        jali_map_colour(jali_map_value(a, opt.quantity, i), opt.limit, top, rgb);
        for (int k = 0; k < 3; k++) TRY(append_float(ctx, ply, sheet->node[i][k]));
        TRY(bytes_append(ctx, ply, rgb, 3));
        TRY(append_float(ctx, ply, jali_map_value(a, JALI_STRESS, i)));
        TRY(append_float(ctx, ply, jali_map_value(a, JALI_DISPLACEMENT, i)));
    }
    for (int32_t t = 0; t < sheet->triangle_count; t++) {
        uint8_t three = 3;
        TRY(bytes_append(ctx, ply, &three, 1));
        TRY(bytes_append(ctx, ply, sheet->triangle[t], sizeof *sheet->triangle));
    }
done:
    return status;
}

// --- VTU

typedef enum field {
    POINTS,
    MOVED,
    TURNED,
    FACES,
    PRINCIPAL,
    RAW,
    MEAN,
    THICKNESS,
    CONNECTIVITY,
    OFFSETS,
    TYPES,
    FIELDS
} field;

static const struct {
    const char *name, *type;
    int32_t components;
    bool of_cells;
} fields[FIELDS] = {
    [POINTS] = {"Points", "Float32", 3, false},
    [MOVED] = {"displacement_mm", "Float32", 3, false},
    [TURNED] = {"rotation_rad", "Float32", 3, false},
    [FACES] = {"von_mises_outer_middle_inner_mpa", "Float32", 3, false},
    [PRINCIPAL] = {"principal_largest_smallest_mpa", "Float32", 2, false},
    [RAW] = {"stress_raw_mpa", "Float32", 1, false},
    [MEAN] = {"stress_mpa", "Float32", 1, false},
    [THICKNESS] = {"thickness_mm", "Float32", 1, false},
    [CONNECTIVITY] = {"connectivity", "Int32", 3, true},
    [OFFSETS] = {"offsets", "Int32", 1, true},
    [TYPES] = {"types", "UInt8", 1, true},
};

static uint64_t bytes_of(const jali_sheet *sheet, field f)
{
    uint64_t each = (uint64_t)fields[f].components * (f == TYPES ? 1 : 4);
    return each * (uint64_t)(fields[f].of_cells ? sheet->triangle_count : sheet->node_count);
}

static jali_status append_declaration(jali_context *ctx, field f, uint64_t offset, jali_bytes *vtu)
{
    return bytes_print(ctx, vtu,
                       "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" "
                       "offset=\"%llu\"/>\n",
                       fields[f].type, fields[f].name, fields[f].components, (unsigned long long)offset);
}

static double node_value(const jali_sheet *sheet, const jali_analysis *a, field f, int32_t i, int32_t k)
{
    switch (f) {
    case POINTS: return sheet->node[i][k];
    case MOVED: return a->displacement[i][k];
    case TURNED: return a->displacement[i][3 + k];
    case FACES: return a->face_mpa[i][k];
    case PRINCIPAL: return a->principal_mpa[i][k];
    case RAW: return a->raw_mpa[i];
    case MEAN: return a->mean_mpa[i];
    default: return sheet->thickness_mm[i];
    }
}

static jali_status append_field(jali_context *ctx, const jali_sheet *sheet, const jali_analysis *a, field f,
                                jali_bytes *vtu)
{
    jali_status status;
    enum { VTK_TRIANGLE = 5 };
    uint64_t size = bytes_of(sheet, f);
    TRY(bytes_append(ctx, vtu, &size, sizeof size));
    if (f == CONNECTIVITY) return bytes_append(ctx, vtu, sheet->triangle, size);
    for (int32_t t = 0; t < sheet->triangle_count && fields[f].of_cells; t++) {
        int32_t end = 3 * (t + 1);
        uint8_t type = VTK_TRIANGLE;
        if (f == OFFSETS)
            TRY(bytes_append(ctx, vtu, &end, sizeof end));
        else
            TRY(bytes_append(ctx, vtu, &type, 1));
    }
    for (int32_t i = 0; i < sheet->node_count && !fields[f].of_cells; i++)
        for (int32_t k = 0; k < fields[f].components; k++)
            TRY(append_float(ctx, vtu, node_value(sheet, a, f, i, k)));
done:
    return status;
}

jali_status jali_map_vtu(jali_context *ctx, const jali_sheet *sheet, const jali_analysis *a, jali_bytes *vtu)
{
    jali_status status;
    static const char *const before[FIELDS] = {[POINTS] = "<Points>\n",
                                               [MOVED] = "</Points>\n<PointData Scalars=\"stress_mpa\" "
                                                         "Vectors=\"displacement_mm\">\n",
                                               [CONNECTIVITY] = "</PointData>\n<Cells>\n"};
    uint64_t offset = 0;
    TRY(bytes_print(ctx, vtu,
                    "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                    "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece "
                    "NumberOfPoints=\"%d\" NumberOfCells=\"%d\">\n",
                    sheet->node_count, sheet->triangle_count));
    for (field f = 0; f < FIELDS; f++) {
        if (before[f]) TRY(bytes_print(ctx, vtu, "%s", before[f]));
        TRY(append_declaration(ctx, f, offset, vtu));
        offset += sizeof(uint64_t) + bytes_of(sheet, f);
    }
    TRY(bytes_print(ctx, vtu, "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_"));
    for (field f = 0; f < FIELDS; f++) TRY(append_field(ctx, sheet, a, f, vtu));
    TRY(bytes_print(ctx, vtu, "\n</AppendedData>\n</VTKFile>\n"));
done:
    return status;
}
