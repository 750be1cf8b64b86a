// lines: every line end, borders of pieces, files and memory.
#include "testing.h"

#include "base/lines.h"

#include <unistd.h>

// The text's lines joined by '|'.
static void joined(lines *in, char *text, size_t room)
{
    bool more;
    size_t used = 0;
    for (;;) {
        CHECK_OK(lines_next(ctx, in, &more));
        if (!more) break;
        used += (size_t)snprintf(text + used, room - used, "%s|", in->text);
    }
    text[used] = 0;
}

static void check_lines(const char *text, const char *want)
{
    lines in;
    char got[256];
    lines_of_bytes(text, strlen(text), "text", &in);
    joined(&in, got, sizeof got);
    assert_string_equal(got, want);
    lines_close(ctx, &in);
}

TEST(lines_end_with_lf_crlf_or_cr)
{
    check_lines("", "");
    check_lines("a", "a|");
    check_lines("a\n", "a|");
    check_lines("a\nb\r\nc\rd", "a|b|c|d|");
    check_lines("\n\r\n\r\r\nx", "||||x|");
    check_lines("a\r", "a|");
}

TEST(a_file_reads_as_its_bytes_do_and_can_be_read_again)
{
    enum { COUNT = 30000 }; // some pieces
    char path[] = "/tmp/jali-lines-XXXXXX", got[32];
    int descriptor = mkstemp(path);
    FILE *file = fdopen(descriptor, "w");
    for (int32_t i = 0; i < COUNT; i++)
        fprintf(file, "%d%s", i, i % 3 == 0 ? "\r\n" : i % 3 == 1 ? "\n" : "\r");
    fclose(file);
    lines in;
    bool more;
    CHECK_OK(lines_open(ctx, path, &in));
    for (int32_t again = 0; again < 2; again++) {
        for (int32_t i = 0; i < COUNT; i++) {
            CHECK_OK(lines_next(ctx, &in, &more));
            snprintf(got, sizeof got, "%d", i);
            CHECK(more && strcmp(in.text, got) == 0 && in.number == i + 1);
        }
        CHECK_OK(lines_next(ctx, &in, &more));
        CHECK(!more && in.at == in.size);
        CHECK_OK(lines_rewind(ctx, &in));
    }
    lines_close(ctx, &in);
    unlink(path);
}

TEST(a_long_line_is_cut_and_says_so)
{
    static char text[3 * LINE_BYTES];
    lines in;
    bool more;
    memset(text, 'x', sizeof text);
    text[sizeof text - 2] = '\n';
    lines_of_bytes(text, sizeof text, "text", &in);
    CHECK_OK(lines_next(ctx, &in, &more));
    CHECK(more && in.cut && in.length == LINE_BYTES - 1);
    CHECK_OK(lines_next(ctx, &in, &more));
    CHECK(more && !in.cut && in.length == 1 && in.number == 2);
}

TEST(what_cannot_be_read_is_a_sentence)
{
    lines in;
    bool more;
    CHECK_STATUS(lines_open(ctx, "/nowhere/at/all", &in), JALI_IO);
    CHECK(strstr(jali_message(ctx), "/nowhere/at/all: No such file"));
    CHECK_STATUS(lines_open(ctx, "/tmp", &in), JALI_IO);
    CHECK(strstr(jali_message(ctx), "directory"));
    lines_of_bytes("a\nb\0c\n", 6, "text", &in);
    CHECK_OK(lines_next(ctx, &in, &more));
    CHECK_STATUS(lines_next(ctx, &in, &more), JALI_BAD_INPUT);
    CHECK(strstr(jali_message(ctx), "text, line 2"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_end_with_lf_crlf_or_cr),
        cmocka_unit_test(a_file_reads_as_its_bytes_do_and_can_be_read_again),
        cmocka_unit_test(a_long_line_is_cut_and_says_so),
        cmocka_unit_test(what_cannot_be_read_is_a_sentence),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
