/* All families in one array. */
#include "tests/torture/families.h"

static const struct family *const tables[] = {families_near, families_shape, families_map};
enum { TABLES = sizeof tables / sizeof *tables };

int32_t family_count(void)
{
    int32_t n = 0;
    for (size_t i = 0; i < TABLES; i++)
        for (const struct family *f = tables[i]; f->name; f++)
            n++;
    return n;
}

const struct family *family_at(int32_t i)
{
    for (size_t k = 0; k < TABLES; k++)
        for (const struct family *f = tables[k]; f->name; f++)
            if (i-- == 0)
                return f;
    return NULL;
}

const struct family *family_named(const char *name)
{
    for (int32_t i = 0; i < family_count(); i++)
        if (strcmp(family_at(i)->name, name) == 0)
            return family_at(i);
    return NULL;
}
