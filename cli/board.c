// jali board: the reference board as a solid, as outlines, or as a picture.
#include "outputs.h"
#include "base/bytes.h"

#include <stdio.h>

static const double PICTURE_PIXEL_MM = 0.05;

// What a board is made of, in every form.
typedef struct board_product {
    jali_board board;
    jali_contours contours;
    jali_mesh mesh;
    jali_check_report check;
} board_product;

static void board_product_free(jali_context *ctx, board_product *p)
{
    jali_board_free(ctx, &p->board);
    jali_contours_free(ctx, &p->contours);
    jali_mesh_free(ctx, &p->mesh);
}

static jali_status make_board(jali_context *ctx, const settings *set, board_product *p)
{
    jali_status status;
    jali_carve_options carve = jali_carve_defaults();
    jali_board_options opt = set->board;
    opt.phi_s_mm = set->make.optimise.phi_s_mm;
    opt.phi_v_mm = set->make.optimise.phi_v_mm;
    for (int k = 0; k < 2; k++) // the bed's
        if (*set->make.printer.bed_mm[k].source)
            opt.most_mm = MIN(opt.most_mm, set->make.printer.bed_mm[k].value);
    if (set->thickness_mm > 0) opt.thickness_mm = set->thickness_mm;
    TRY(jali_board_layout(ctx, &opt, &p->board));
    TRY(jali_board_contours(ctx, &p->board, &p->contours));
    carve.thickness_mm = p->board.thickness_mm;
    TRY(jali_carve(ctx, &p->contours, &(jali_chart){.unit_mm = p->contours.unit_mm}, &carve, &p->mesh));
    TRY(jali_check(ctx, &p->mesh, NULL, &p->check));
    if (!p->check.solid || p->check.pieces != 1)
        TRY(fail(ctx, JALI_BROKEN, "the board is not one closed solid: this is a fault of jali"));
done:
    return status;
}

static jali_status board_bytes(jali_context *ctx, const settings *set, const board_product *p,
                               jali_format format, jali_bytes *bytes)
{
    jali_status status;
    jali_bitmap bitmap = {0};
    char words[200];
    double pixel_mm = set->make.place.pixel_mm > 0 ? set->make.place.pixel_mm : PICTURE_PIXEL_MM;
    snprintf(words, sizeof words, "jali %s: reference board for phi_s %g, phi_v %g mm, %.4g x %.4g x %g mm",
             jali_version(), p->board.phi_s_mm, p->board.phi_v_mm, p->board.width_mm, p->board.height_mm,
             p->board.thickness_mm);
    jali_product product = {.mesh = &p->mesh,
                            .contours = &p->contours,
                            .width_mm = p->board.width_mm,
                            .height_mm = p->board.height_mm};
    jali_write_options opt = {.title = "reference board", .parameters = words};
    if (format == JALI_FORMAT_PNG) TRY(jali_board_bitmap(ctx, &p->board, &pixel_mm, &bitmap));
    product.bitmap = &bitmap;
    product.pixel_mm = pixel_mm;
    TRY(jali_write_bytes(ctx, format, &product, &opt, bytes));
done:
    jali_bitmap_free(ctx, &bitmap);
    return status;
}

jali_status run_board(jali_context *ctx, const settings *set)
{
    jali_status status;
    board_product p = {0};
    jali_bytes bytes[MOST_OUTPUTS + 1] = {0};
    output out[MOST_OUTPUTS + 1];
    int32_t count = 0;
    TRY(make_board(ctx, set, &p));
    for (; count < set->output_count; count++) {
        const char *path = set->output[count];
        jali_format format = strcmp(path, "-") == 0 ? JALI_FORMAT_3MF : jali_format_of(path);
        out[count] = (output){path, &bytes[count]};
        TRY(board_bytes(ctx, set, &p, format, &bytes[count]));
    }
    if (set->render) {
        out[count] = (output){set->render, &bytes[count]};
        TRY(render_png(ctx, &p.mesh, &set->view, set->size_px, &bytes[count]));
        count++;
    }
    TRY(write_outputs(ctx, out, count));
    say(set, "%.4g x %.4g x %g mm, %d widths of %d features; expected: phi_s %g, phi_v %g mm",
        p.board.width_mm, p.board.height_mm, p.board.thickness_mm, p.board.columns, p.board.feature_count,
        p.board.phi_s_mm, p.board.phi_v_mm);
done:
    for (int32_t i = 0; i < MOST_OUTPUTS + 1; i++) jali_bytes_free(ctx, &bytes[i]);
    board_product_free(ctx, &p);
    return status;
}
