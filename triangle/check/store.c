/* Half-edges in memory, or in files by a hash of their edge: all of one edge come into one file. */
#include "triangle/check/store.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { N_FILES = 128, LEAST_ROOM = 256 };

struct check_store {
    struct check_opens here;
    int64_t most;        /* to be in memory */
    FILE *file[N_FILES]; /* NULL: not there yet */
    int64_t n[N_FILES];  /* half-edges in it */
};

enum tri_status tri_check_store_new(struct checker *c)
{
    c->store = calloc(1, sizeof *c->store);
    if (c->store == NULL)
        return TRI_NO_MEMORY;
    c->store->most = INT64_MAX;
    if (c->source->memory > 0)
        c->store->most = LEAST_ROOM + (int64_t)(c->source->memory / 8 / sizeof(struct check_open));
    return TRI_OK;
}

void tri_check_store_free(struct check_store *s)
{
    for (int i = 0; s != NULL && i < N_FILES; i++) {
        if (s->file[i] != NULL)
            (void)fclose(s->file[i]);
    }
    if (s != NULL)
        free(s->here.at);
    free(s);
}

enum tri_status tri_check_append(struct check_opens *o, const struct check_open *e)
{
    if (o->n == o->room) {
        int64_t room = o->room + o->room / 2 + 64;
        struct check_open *at = (uint64_t)room < SIZE_MAX / sizeof *at ? realloc(o->at, (size_t)room * sizeof *at) : NULL;
        if (at == NULL)
            return TRI_NO_MEMORY;
        o->at = at;
        o->room = room;
    }
    o->at[o->n++] = *e;
    return TRI_OK;
}

static int file_of(const struct check_open *e)
{
    uint64_t low = (uint64_t)(e->from < e->to ? e->from : e->to), high = (uint64_t)(e->from < e->to ? e->to : e->from);
    uint64_t h = (low * 0x9e3779b97f4a7c15u ^ high) * 0xbf58476d1ce4e5b9u;
    return (int)(h >> 57);
}

static enum tri_status fail(struct checker *c)
{
    const char *folder = c->source->scratch != NULL ? c->source->scratch : "/tmp";
    return tri_fail(c->error, TRI_CANNOT_WRITE, folder, 0, "cannot park half-edges there: %s", strerror(errno));
}

static FILE *open_file(const struct checker *c)
{
    char name[1024];
    const char *folder = c->source->scratch != NULL ? c->source->scratch : "/tmp";
    if (snprintf(name, sizeof name, "%s/trianglecheck-XXXXXX", folder) >= (int)sizeof name) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    int descriptor = mkstemp(name);
    FILE *file = descriptor < 0 ? NULL : fdopen(descriptor, "w+b");
    if (descriptor >= 0)
        (void)unlink(name); /* it goes with the process, however that ends */
    if (descriptor >= 0 && file == NULL)
        (void)close(descriptor);
    return file;
}

/* All that is in memory goes to the files. */
static enum tri_status park(struct checker *c)
{
    struct check_store *s = c->store;
    for (int64_t i = 0; i < s->here.n; i++) {
        int k = file_of(&s->here.at[i]);
        if (s->file[k] == NULL && (s->file[k] = open_file(c)) == NULL)
            return fail(c);
        if (fwrite(&s->here.at[i], sizeof *s->here.at, 1, s->file[k]) != 1)
            return fail(c);
        s->n[k]++;
    }
    s->here.n = 0;
    return TRI_OK;
}

enum tri_status tri_check_store_add(struct checker *c, struct check_open e)
{
    enum tri_status status = c->store->here.n >= c->store->most ? park(c) : TRI_OK;
    return status == TRI_OK ? tri_check_append(&c->store->here, &e) : status;
}

static enum tri_status fetch(struct checker *c, int k)
{
    struct check_store *s = c->store;
    s->here.n = 0;
    if (s->n[k] > s->here.room) {
        free(s->here.at);
        s->here.room = 0;
        s->here.at = tri_check_array(s->n[k], sizeof *s->here.at);
        if (s->here.at == NULL)
            return TRI_NO_MEMORY;
        s->here.room = s->n[k];
    }
    rewind(s->file[k]);
    if (fread(s->here.at, sizeof *s->here.at, (size_t)s->n[k], s->file[k]) != (size_t)s->n[k])
        return tri_fail(c->error, TRI_CANNOT_READ, "", 0, "cannot read what was parked");
    (void)fclose(s->file[k]);
    s->file[k] = NULL;
    s->here.n = s->n[k];
    s->n[k] = 0;
    return TRI_OK;
}

enum tri_status tri_check_store_drain(struct checker *c, enum tri_status (*take)(struct checker *c,
                                                                                 struct check_open *at, int64_t n))
{
    struct check_store *s = c->store;
    bool parked = false;
    for (int k = 0; k < N_FILES; k++)
        parked = parked || s->file[k] != NULL;
    enum tri_status status = parked ? park(c) : take(c, s->here.at, s->here.n);
    for (int k = 0; k < N_FILES && status == TRI_OK; k++) {
        if (s->file[k] == NULL)
            continue;
        status = fetch(c, k);
        status = status == TRI_OK ? take(c, s->here.at, s->here.n) : status;
    }
    free(s->here.at);
    s->here = (struct check_opens){0};
    return status;
}
