// The code: what a board is, in one row of square voids along its lower edge, with a checksum.
//
// Source:  the checksum is the CRC-12 with the polynomial x^12 + x^11 + x^3 + x^2 + x + 1.
// Checked: tests/test_board.c: every board's code reads back; one or two wrong bits never pass.
#include "board/layout.h"

enum { SUM_BITS = 12, DATA_BITS = JALI_BOARD_CODE_BITS - SUM_BITS, SUM_POLYNOMIAL = 0x80f };

// What the data bits hold, the first field first, each with its most significant bit first.
enum { VERSION = 0, VERSION_BITS = 2, PHI_BITS = 8, COLUMN_BITS = 4, STEP_BITS = 2 };
_Static_assert(VERSION_BITS + 2 * PHI_BITS + COLUMN_BITS + STEP_BITS == DATA_BITS,
               "the fields fill the data");

static const double FIRST_SHARE = 0.1; // of the lower edge between the corner marks; the last one at 1 - that

void jali_board_mark_share(int32_t mark, double share[2])
{
    // The odd mark makes any turn and any mirror image another arrangement.
    static const double shares[JALI_BOARD_MARKS][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.3, 1}};
    memcpy(share, shares[mark], sizeof shares[mark]);
}

void jali_board_code_share(int32_t bit, double share[2])
{
    share[0] = FIRST_SHARE + (1 - 2 * FIRST_SHARE) * bit / (JALI_BOARD_CODE_BITS - 1);
    share[1] = 0;
}

// Begins from ones: a board without a single void square does not pass.
static int32_t checksum(const bool *bit)
{
    int32_t sum = (1 << SUM_BITS) - 1;
    for (int32_t i = 0; i < DATA_BITS; i++) {
        bool high = (sum >> (SUM_BITS - 1) & 1) != bit[i];
        sum = (sum << 1 & ((1 << SUM_BITS) - 1)) ^ (high ? SUM_POLYNOMIAL : 0);
    }
    return sum;
}

static bool *put(bool *bit, int32_t value, int32_t bits)
{
    for (int32_t i = bits - 1; i >= 0; i--) *bit++ = value >> i & 1;
    return bit;
}

static int32_t take(const bool **bit, int32_t bits)
{
    int32_t value = 0;
    for (int32_t i = 0; i < bits; i++) value = 2 * value + *(*bit)++;
    return value;
}

void write_code(const board_figures *f, bool code[JALI_BOARD_CODE_BITS])
{
    bool *bit = put(code, VERSION, VERSION_BITS);
    bit = put(bit, f->phi_s, PHI_BITS);
    bit = put(bit, f->phi_v, PHI_BITS);
    bit = put(bit, f->columns, COLUMN_BITS);
    bit = put(bit, f->cell_step, STEP_BITS);
    put(bit, checksum(code), SUM_BITS);
}

jali_status jali_board_decode(jali_context *ctx, const bool code[JALI_BOARD_CODE_BITS], jali_board *board)
{
    const bool *bit = code;
    board_figures f;
    *board = (jali_board){0};
    int32_t version = take(&bit, VERSION_BITS);
    f.phi_s = take(&bit, PHI_BITS);
    f.phi_v = take(&bit, PHI_BITS);
    f.columns = take(&bit, COLUMN_BITS);
    f.cell_step = take(&bit, STEP_BITS);
    if (take(&bit, SUM_BITS) != checksum(code))
        return fail(ctx, JALI_BAD_INPUT, "the board's code cannot be read: its checksum is wrong");
    if (version != VERSION || !possible(&f))
        return fail(ctx, JALI_BAD_INPUT, "the board's code stands for no board this version knows");
    return lay_out(ctx, &f, board);
}
