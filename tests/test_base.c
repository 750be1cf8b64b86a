// The context: limits, cancelling, the arena, the pool.
#include "testing.h"

#include "base/file.h"
#include "base/lines.h"

TEST(arena_gives_back_what_a_stage_took)
{
    arena_mark mark = arena_here(ctx);
    int32_t *a, *b;
    CHECK_OK(ARENA(ctx, a, 1000));
    CHECK_OK(ARENA(ctx, b, 10000000));
    CHECK(a != b && (uintptr_t)a % 64 == 0 && (uintptr_t)b % 64 == 0);
    arena_rewind(ctx, mark);
    CHECK(arena_here(ctx).chunk == mark.chunk);
}

static void square(void *shared, int32_t index)
{
    ((int32_t *)shared)[index] = index * index;
}

TEST(threads_of_a_pool_call_each_index_once)
{
    int32_t result[500];
    for (int32_t round = 0; round < 50; round++) {
        memset(result, 0, sizeof result);
        parallel(ctx, 500, square, result);
        for (int32_t i = 0; i < 500; i++) CHECK_INT(result[i], i * i);
    }
}

typedef struct nest {
    jali_context *ctx;
    int32_t result[20][60];
} nest;

static void square_each(void *shared, int32_t index)
{
    nest *n = shared;
    parallel(n->ctx, 60, square, n->result[index]);
}

TEST(threads_of_a_pool_run_what_they_call_themselves)
{
    nest n = {.ctx = ctx};
    for (int32_t round = 0; round < 50; round++) {
        memset(n.result, 0, sizeof n.result);
        parallel(ctx, 20, square_each, &n);
        for (int32_t i = 0; i < 20; i++)
            for (int32_t k = 0; k < 60; k++) CHECK_INT(n.result[i][k], k * k);
    }
}

// A task that allocates, is parallel within and may fail.
typedef struct task {
    int32_t *result; // [500]
    jali_status fails;
    const char *why;
} task;

static jali_status fill_and_fail(jali_context *limited, void *of_task)
{
    jali_status status;
    task *t = of_task;
    arena_mark mark = arena_here(limited);
    int32_t *scratch;
    TRY(ALLOCATE(limited, t->result, 500));
    for (int32_t round = 0; round < 20; round++) {
        TRY(ARENA(limited, scratch, 500));
        parallel(limited, 500, square, scratch);
        memcpy(t->result, scratch, 500 * sizeof *scratch);
        TRY(step(limited, "task", round / 20.0));
    }
    if (t->fails != JALI_OK) status = fail(limited, t->fails, "%s", t->why);
done:
    arena_rewind(limited, mark);
    return status;
}

static jali_status fill_both(jali_context *limited, void *of_tasks)
{
    task *t = of_tasks;
    for (int i = 0; i < 2; i++) t[i].result = NULL;
    jali_status status = do_both(limited, fill_and_fail, &t[0], fill_and_fail, &t[1]);
    for (int32_t i = 0; i < 500 && status == JALI_OK; i++)
        CHECK(t[0].result[i] == i * i && t[1].result[i] == i * i);
    for (int i = 0; i < 2; i++) release(limited, t[i].result);
    return status;
}

TEST(two_tasks_at_one_time_share_nothing)
{
    task t[2] = {{.why = "own"}, {.why = "other"}};
    for (int32_t round = 0; round < 50; round++) CHECK_OK(fill_both(ctx, t));
    t[1].fails = JALI_IO;
    CHECK_INT(fill_both(ctx, t), JALI_IO);
    assert_string_equal(jali_message(ctx), "other");
    t[0].fails = JALI_NO_RESULT;
    CHECK_INT(fill_both(ctx, t), JALI_NO_RESULT);
    assert_string_equal(jali_message(ctx), "own");
    t[0].fails = t[1].fails = JALI_OK;
    refuse_each_allocation(fill_both, t);
    CHECK_OK(fill_both(ctx, t)); // nothing was left behind
    jali_cancel(ctx);
    CHECK_INT(fill_both(ctx, t), JALI_CANCELLED);
}

TEST(memory_limit_is_a_sentence)
{
    jali_context_options opt = jali_context_defaults();
    opt.max_memory_bytes = 1 << 20;
    jali_context *small;
    CHECK_INT(jali_context_create(&opt, &small), JALI_OK);
    jali_bitmap big;
    CHECK_STATUS(jali_bitmap_create(small, 100000, 100000, &big), JALI_LIMIT);
    CHECK(strstr(jali_message(small), "limit of 1 MB") != NULL);
    CHECK(big.word == NULL);
    jali_context_free(small);
}

TEST(cancel_and_timeout_stop_the_next_step)
{
    CHECK_OK(step(ctx, "test", 0));
    jali_cancel(ctx);
    CHECK(stopping(ctx));
    CHECK_STATUS(step(ctx, "test", 0.5), JALI_CANCELLED);
    jali_context_options opt = jali_context_defaults();
    opt.timeout_seconds = 1e-9;
    jali_context *late;
    CHECK_INT(jali_context_create(&opt, &late), JALI_OK);
    CHECK_STATUS(step(late, "test", 0), JALI_LIMIT);
    jali_context_free(late);
}

TEST(bad_context_options_are_refused)
{
    jali_context *none;
    CHECK_INT(jali_context_create(&(jali_context_options){.threads = -1}, &none), JALI_BAD_VALUE);
    CHECK(none == NULL);
}

static bool take_into(void *user, const char *name, const void *data, size_t size)
{
    char *text = user;
    snprintf(text + strlen(text), 64 - strlen(text), "%s:%.*s;", name, (int)size,
             data ? (const char *)data : "");
    return strlen(text) < 40;
}

TEST(a_run_in_memory_opens_no_files)
{
    char taken[64] = "";
    const jali_file file = {"a.txt", "one\ntwo\n", 8};
    const jali_files files = {1, &file, take_into, taken};
    jali_context_options opt = jali_context_defaults();
    jali_context *closed;
    jali_bytes bytes;
    lines in;
    opt.files = &files;
    CHECK_INT(jali_context_create(&opt, &closed), JALI_OK);
    CHECK_INT(file_read(closed, "a.txt", 8, &bytes), JALI_OK);
    CHECK(bytes.size == 8 && memcmp(bytes.data, file.data, 8) == 0 && bytes.data[8] == 0);
    jali_bytes_free(closed, &bytes);
    CHECK_INT(file_read(closed, "a.txt", 7, &bytes), JALI_LIMIT);
    CHECK_INT(file_read(closed, "/etc/passwd", 1000000, &bytes), JALI_IO);
    CHECK(strstr(jali_message(closed), "/etc/passwd"));
    CHECK_INT(file_read(closed, "-", 1000000, &bytes), JALI_IO);
    CHECK(file_exists(closed, "a.txt") && !file_exists(closed, "/etc/passwd"));
    CHECK_INT(lines_open(closed, "a.txt", &in), JALI_OK);
    lines_close(closed, &in);
    CHECK_INT(lines_open(closed, "/etc/passwd", &in), JALI_IO);
    CHECK_INT(file_write(closed, "/tmp/b.txt", "three", 5), JALI_OK);
    CHECK(strcmp(taken, "/tmp/b.txt:three;/tmp/b.txt:;") == 0);
    CHECK_INT(file_write(closed, "c.txt", "four, which is too long", 23), JALI_IO);
    jali_context_free(closed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(arena_gives_back_what_a_stage_took, open_context, close_context),
        cmocka_unit_test_setup_teardown(threads_of_a_pool_call_each_index_once, open_context, close_context),
        cmocka_unit_test_setup_teardown(threads_of_a_pool_run_what_they_call_themselves, open_context,
                                        close_context),
        cmocka_unit_test_setup_teardown(two_tasks_at_one_time_share_nothing, open_context, close_context),
        cmocka_unit_test_setup_teardown(memory_limit_is_a_sentence, open_context, close_context),
        cmocka_unit_test_setup_teardown(cancel_and_timeout_stop_the_next_step, open_context, close_context),
        cmocka_unit_test_setup_teardown(bad_context_options_are_refused, open_context, close_context),
        cmocka_unit_test_setup_teardown(a_run_in_memory_opens_no_files, open_context, close_context),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
