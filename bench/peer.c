// The same operations by Leptonica, on the same picture, in the same run: bit-packed as ours are.
#include "bench.h"

#ifdef BENCH_HAVE_LEPTONICA
#include <leptonica/allheaders.h>

static PIX *as_pix(const jali_bitmap *a)
{
    PIX *pix = pixCreate(a->width_px, a->height_px, 1);
    for (int32_t y = 0; pix && y < a->height_px; y++)
        for (int32_t x = 0; x < a->width_px; x++)
            if (jali_bitmap_get(a, x, y)) pixSetPixel(pix, x, y, 1);
    return pix;
}

enum { MOST_RUNS = 100 };

double peer_opening(subject *s, int32_t size, int32_t runs)
{
    double ms[MOST_RUNS];
    PIX *pix = as_pix(&s->drawing);
    for (int32_t i = 0; i < runs; i++) {
        double begun = now_ms();
        PIX *opened = pixOpenBrickDwa(NULL, pix, size, size);
        ms[i] = now_ms() - begun;
        pixDestroy(&opened);
    }
    pixDestroy(&pix);
    return median(ms, runs);
}

double peer_and(subject *s, int32_t size, int32_t runs)
{
    (void)size;
    double ms[MOST_RUNS];
    PIX *a = as_pix(&s->drawing), *b = pixCopy(NULL, a);
    for (int32_t i = 0; i < runs; i++) {
        double begun = now_ms();
        pixAnd(b, b, a);
        ms[i] = now_ms() - begun;
    }
    pixDestroy(&a);
    pixDestroy(&b);
    return median(ms, runs);
}

double peer_components(subject *s, int32_t size, int32_t runs)
{
    (void)size;
    double ms[MOST_RUNS];
    PIX *pix = as_pix(&s->drawing);
    for (int32_t i = 0; i < runs; i++) {
        l_int32 count;
        double begun = now_ms();
        pixCountConnComp(pix, 4, &count);
        ms[i] = now_ms() - begun;
    }
    pixDestroy(&pix);
    return median(ms, runs);
}
#else
double peer_opening(subject *s, int32_t size, int32_t runs)
{
    (void)s, (void)size, (void)runs;
    return -1;
}

double peer_and(subject *s, int32_t size, int32_t runs)
{
    return peer_opening(s, size, runs);
}

double peer_components(subject *s, int32_t size, int32_t runs)
{
    return peer_opening(s, size, runs);
}
#endif
