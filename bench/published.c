// The table of docs/analyse.md: published cases of plates and shells, and what the facet makes of them.
#include "published.h"
#include "mitc.h"

#include <jali/base.h>
#include <stdio.h>

int main(void)
{
    jali_context *with;
    if (jali_context_create(NULL, &with) != JALI_OK) return 1;
    printf(
        "| case | reference | source | mesh | value | ratio | must lie within | MITC3+ | half the mesh |\n");
    printf("|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < PUBLISHED_COUNT; i++) {
        const published *p = &PUBLISHED[i];
        double value = p->value(with, p->n, facet_stiffness, p->which),
               other = p->value(with, p->n, mitc_stiffness, p->which);
        double half = p->value(with, (p->n + 1) / 2, facet_stiffness, p->which);
        printf("| %s | %.6g | %s | %s | %.6g | %.4f | %+.1f .. %+.1f %% | %.4f | %.4f |%s\n", p->name,
               p->reference, p->source, p->mesh, value, value / p->reference, p->low, p->high,
               other / p->reference, half / p->reference,
               value / p->reference < 1 + p->low / 100 || value / p->reference > 1 + p->high / 100 ? " <---"
                                                                                                   : "");
        fflush(stdout);
    }
    jali_context_free(with);
    return 0;
}
