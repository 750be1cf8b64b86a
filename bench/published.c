// The table of docs/analyse.md: published cases of plates and shells, and what the facet makes of them. The
// last two columns: another element of the same theory (tests/mitc.h), and half the mesh.
#include "published.h"
#include "mitc.h"

#include <jali/base.h>
#include <stdio.h>

int main(void)
{
    jali_context *with;
    if (jali_context_create(NULL, &with) != JALI_OK) return 1;
    printf("| case | source | mesh | reference | ours | ratio | allowed, %% | MITC3+ | half the mesh |\n");
    printf("|---|---|---|---|---|---|---|---|---|\n");
    int missed = 0;
    for (int i = 0; i < PUBLISHED_COUNT; i++) {
        const published *p = &PUBLISHED[i];
        double ours = p->value(with, p->n, facet_stiffness, p->which) / p->reference;
        double other = p->value(with, p->n, mitc_stiffness, p->which) / p->reference;
        double half = p->value(with, (p->n + 1) / 2, facet_stiffness, p->which) / p->reference;
        printf("| %s | %s | %s | %.6g | %.6g | %.4f | %+g .. %+g | %.4f | ", p->name, p->source, p->mesh,
               p->reference, ours * p->reference, ours, p->low, p->high, other);
        printf(p->n > 1 ? "%.4f |\n" : "|\n", half);
        if (!(ours >= 1 + p->low / 100 && ours <= 1 + p->high / 100)) missed++;
    }
    jali_context_free(with);
    return missed ? 1 : 0;
}
