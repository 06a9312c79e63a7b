/* Messages as bytes: whole numbers seven bits at a time, the least first. One walk over a message both writes it and
 * reads it: what is said of a field here holds for both. */
#include "sched/ranks/talk.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/tunables.h"
#include "triangle/base/grow.h"
#include "triangle/base/hash.h"

struct coder {
    struct par_bytes *to;              /* what is written; NULL: all is read, .. */
    const unsigned char *at, *end;     /* .. from here */
    bool failed;                       /* no memory, or what is read is no message */
    const struct tri_mesh *mesh;
    int32_t n_common;
    int32_t vertices, triangles, subs; /* numbers that had been told before */
};

/* --- numbers */

enum { LONGEST = 16 }; /* bytes of a number at most */

/* Where the next LONGEST bytes may go; NULL: no memory. */
static char *room_for_one(struct coder *c)
{
    struct par_bytes *to = c->to;
    c->failed = c->failed || (to->capacity - to->n < LONGEST && !par_bytes_reserve(to, PAR_MESSAGE_GROWTH));
    return c->failed ? NULL : to->at + to->n;
}

static void put_number(struct coder *c, uint64_t n)
{
    char *at = room_for_one(c);
    if (!at)
        return;
    for (; n >= 128; n >>= 7)
        *at++ = (char)((n & 127) | 128);
    *at++ = (char)n;
    c->to->n = (size_t)(at - c->to->at);
}

static uint64_t get_number(struct coder *c)
{
    uint64_t n = 0;
    for (int shift = 0; shift < 64 && c->at < c->end; shift += 7) {
        unsigned char byte = *c->at++;
        n |= (uint64_t)(byte & 127) << shift;
        if (byte < 128)
            return n;
    }
    c->failed = true;
    return 0;
}

static void code(struct coder *c, uint64_t *n)
{
    if (c->to)
        put_number(c, *n);
    else
        *n = get_number(c);
}

/* A number from `from` to end - 1. */
static void code_from(struct coder *c, int32_t *n, int32_t from, int64_t end)
{
    uint64_t ahead = c->to ? (uint64_t)(*n - from) : 0;
    code(c, &ahead);
    c->failed = c->failed || end <= from || ahead >= (uint64_t)(end - from);
    *n = c->failed ? 0 : (int32_t)(from + (int64_t)ahead);
}

static void code_below(struct coder *c, int32_t *n, int64_t end) { code_from(c, n, 0, end); }

/* A number from 0 to `from`, counted back from there. */
static void code_back(struct coder *c, int32_t *n, int32_t from)
{
    int32_t back = c->to ? from - *n : 0;
    code_below(c, &back, (int64_t)from + 1);
    *n = from - back;
}

static void code_signed(struct coder *c, int64_t *n)
{
    uint64_t folded = !c->to ? 0 : *n < 0 ? 2 * ~(uint64_t)*n + 1 : 2 * (uint64_t)*n;
    code(c, &folded);
    *n = folded % 2 ? ~(int64_t)(folded / 2) : (int64_t)(folded / 2);
}

static void code_int(struct coder *c, int32_t *n)
{
    int64_t wide = c->to ? *n : 0;
    code_signed(c, &wide);
    *n = (int32_t)wide;
}

/* A number from 0 to end - 1, told as its difference from another. */
static void code_near(struct coder *c, int32_t *n, int32_t from, int32_t end)
{
    int64_t ahead = c->to ? (int64_t)*n - from : 0;
    code_signed(c, &ahead);
    c->failed = c->failed || ahead < -(int64_t)from || ahead >= (int64_t)end - from;
    *n = c->failed ? 0 : (int32_t)(from + ahead);
}

/* The n lowest of eight bytes. The others are written, too, where what comes next will be; and what may be read has
 * eight bytes behind it (the hash). */
static void code_lowest(struct coder *c, uint64_t *word, unsigned n)
{
    char *at = c->to ? room_for_one(c) : NULL;
    c->failed = c->failed || (!c->to && (size_t)(c->end - c->at) < n);
    if (c->failed || n == 0) {
        *word = 0;
    } else if (at) {
        for (unsigned k = 0; k < sizeof *word; k++)
            at[k] = (char)(*word >> 8 * k);
        c->to->n += n;
    } else {
        *word = 0;
        for (unsigned k = 0; k < sizeof *word; k++)
            *word |= (uint64_t)c->at[k] << 8 * k;
        *word &= UINT64_MAX >> 8 * (sizeof *word - n);
        c->at += n;
    }
}

static void code_bytes(struct coder *c, void *item, size_t n)
{
    if (c->to)
        c->failed = c->failed || !par_bytes_add(c->to, item, n);
    else
        c->failed = c->failed || (size_t)(c->end - c->at) < n;
    if (c->failed || c->to || n == 0)
        return;
    memcpy(item, c->at, n);
    c->at += n;
}

/* What lies between one and the next: none comes twice. */
static void code_ascending(struct coder *c, struct par_ids *list, int32_t end)
{
    for (int32_t i = 0, least = 0; !c->failed && i < list->n; least = list->item[i++] + 1)
        code_from(c, &list->item[i], least, end);
}

/* --- vertices */

enum { COMMON, FREE, OTHER, KINDS };

/* Numbers that go with a place: two coordinates and a size. They differ little from those told before: the bits in
 * which they do are told, without the bytes of zeros in front of them. */
enum { REALS = 3, LENGTHS = sizeof(uint64_t) + 1 };
struct reals {
    uint64_t bits[REALS];
};

static unsigned bytes_in(uint64_t word) { return word ? (unsigned)(71 - __builtin_clzll(word)) / 8 : 0; }

/* What comes before a vertex that is not common: its kind, and how many bytes follow of each number. */
static int32_t header_of(const struct par_told_vertex *v, const struct reals *last, struct reals *differing)
{
    const double real[REALS] = {v->xy.x, v->xy.y, v->feature};
    unsigned header = 0;
    memcpy(differing, real, sizeof real);
    for (int k = REALS - 1; k >= 0; k--) {
        differing->bits[k] ^= last->bits[k];
        header = header * LENGTHS + bytes_in(differing->bits[k]);
    }
    return (int32_t)header * KINDS + (v->on == TRI_VERTEX_FREE && v->marker == 0 ? FREE : OTHER);
}

static void code_place(struct coder *c, struct par_told_vertex *v, struct reals *last, struct reals *differing,
                       unsigned lengths)
{
    double real[REALS];
    for (int k = 0; k < REALS; k++, lengths /= LENGTHS) {
        code_lowest(c, &differing->bits[k], lengths % LENGTHS);
        last->bits[k] ^= differing->bits[k];
    }
    memcpy(real, last, sizeof real);
    v->xy = (struct tri_point){real[0], real[1]};
    v->feature = real[2];
}

static void code_vertex(struct coder *c, struct par_told_vertex *v, struct reals *last)
{
    struct reals differing = {{0}};
    int32_t header = COMMON;
    if (!c->to)
        *v = (struct par_told_vertex){.common = TRI_NONE, .on = TRI_VERTEX_FREE};
    else if (v->common == TRI_NONE)
        header = header_of(v, last, &differing);
    code_below(c, &header, KINDS * LENGTHS * LENGTHS * LENGTHS);
    c->failed = c->failed || (header % KINDS == COMMON && header != COMMON);
    if (header % KINDS == COMMON) {
        code_below(c, &v->common, c->n_common);
        return;
    }
    code_place(c, v, last, &differing, (unsigned)header / KINDS);
    if (header % KINDS == OTHER) {
        code_int(c, &v->on);
        code_int(c, &v->marker);
    }
}

static void code_vertices(struct coder *c, struct par_message *m)
{
    struct reals last = {{0}};
    for (int32_t i = 0; !c->failed && i < m->n_vertices; i++)
        code_vertex(c, &m->vertex[i], &last);
}

/* --- triangles */

/* The byte at the beginning of a triangle: which edges lead to triangles that have been told; is the corner opposite to
 * its parent, the first of them that is in this message, new; is the region another one; which is the parent's edge; is
 * the first of them the parent, and the triangle before this one. */
enum { NEW_APEX = 8, OTHER_REGION = 16, PARENT_EDGE = 32, LAST_IS_PARENT = 128 };

/* The first edge that leads to a triangle of the same message, which begins with number `first`; 3: none does. */
static int parent_of(const struct par_told_triangle *t, int32_t first)
{
    int e = 0;
    while (e < 3 && (t->next[e] == TRI_NONE || t->next[e] < first))
        e++;
    return e;
}

static uint64_t flags_of(const struct par_message *m, int32_t first, int32_t i, int32_t top, int32_t region)
{
    const struct par_told_triangle *t = &m->triangle[i];
    int parent = parent_of(t, first), flags = t->region != region ? OTHER_REGION : 0;
    for (int e = 0; e < 3; e++)
        flags |= (t->next[e] != TRI_NONE) << e;
    if (parent < 3) {
        const struct par_told_triangle *other = &m->triangle[t->next[parent] - first];
        flags |= par_edge_between(other->v, t->v[tri_prev[parent]], t->v[tri_next[parent]]) * PARENT_EDGE;
        flags |= t->v[parent] == top ? NEW_APEX : 0;
        bool is_first = (flags & ((1 << parent) - 1)) == 0;
        flags |= is_first && t->next[parent] == first + i - 1 ? LAST_IS_PARENT : 0;
    }
    return (uint64_t)flags;
}

static void code_links(struct coder *c, struct par_told_triangle *t, int32_t number, int flags)
{
    bool last_is_parent = flags & LAST_IS_PARENT;
    for (int e = 0; e < 3; e++) {
        if (!(flags >> e & 1))
            t->next[e] = TRI_NONE;
        else if (last_is_parent)
            t->next[e] = number - 1;
        else
            code_back(c, &t->next[e], number - 1);
        last_is_parent = last_is_parent && !(flags >> e & 1);
    }
}

static void code_corners(struct coder *c, struct par_message *m, struct par_told_triangle *t, int flags, int32_t *top)
{
    int parent = parent_of(t, c->triangles), edge = flags / PARENT_EDGE % 4;
    c->failed = c->failed || edge == 3;
    if (c->failed)
        return;
    if (parent < 3) {
        const struct par_told_triangle *other = &m->triangle[t->next[parent] - c->triangles];
        t->v[tri_prev[parent]] = other->v[tri_next[edge]];
        t->v[tri_next[parent]] = other->v[tri_prev[edge]];
    }
    for (int k = 0; k < 3; k++) {
        if (parent == 3 || (k == parent && !(flags & NEW_APEX)))
            code_back(c, &t->v[k], *top);
        else if (k == parent)
            t->v[k] = *top;
        *top += t->v[k] == *top;
    }
}

static void code_triangles(struct coder *c, struct par_message *m)
{
    int32_t top = c->vertices, region = 0;
    for (int32_t i = 0; !c->failed && i < m->n_triangles; i++) {
        struct par_told_triangle *t = &m->triangle[i];
        uint64_t flags = c->to ? flags_of(m, c->triangles, i, top, region) : 0;
        code_lowest(c, &flags, 1);
        c->failed = c->failed || (i == 0 && flags & LAST_IS_PARENT);
        if (c->failed)
            return;
        code_links(c, t, c->triangles + i, (int)flags);
        code_corners(c, m, t, (int)flags, &top);
        if (flags & OTHER_REGION)
            code_below(c, &t->region, c->mesh->n_regions);
        else
            t->region = region;
        region = t->region;
    }
    c->failed = c->failed || top != c->vertices + m->n_vertices;
}

/* --- the rest */

static void code_sides(struct coder *c, struct par_message *m)
{
    int32_t top = c->subs, end = c->subs + m->n_new_subs, last = 0;
    for (int32_t i = 0; !c->failed && i < m->n_sides; i++) {
        struct par_told_side *s = &m->side[i];
        int32_t flags = c->to ? s->edge << 2 | s->side << 1 | s->is_boundary : 0;
        code_near(c, &s->triangle, last, c->triangles + m->n_triangles);
        code_below(c, &flags, 3 << 2);
        code_back(c, &s->sub, top);
        last = s->triangle;
        s->edge = flags >> 2;
        s->side = flags >> 1 & 1;
        s->is_boundary = flags & 1;
        if (s->sub < top) {
            s->marker = s->parent = 0;
            continue;
        }
        code_int(c, &s->marker);
        code_below(c, &s->parent, c->mesh->n_parents);
        c->failed = c->failed || top++ >= end;
    }
    c->failed = c->failed || top != end;
}

static void code_entries(struct coder *c, struct par_message *m)
{
    uint64_t key = 0;
    int32_t last = 0;
    for (int32_t i = 0; !c->failed && i < m->n_entries; i++) {
        struct par_told_entry *entry = &m->entry[i];
        uint64_t ahead = c->to ? entry->key - key : 0;
        assert(!c->to || entry->key >= key);
        code(c, &ahead);
        entry->key = key += ahead;
        code_near(c, &entry->triangle, last, c->triangles + m->n_triangles);
        last = entry->triangle;
    }
}

/* Each of what is counted takes a byte at least. */
static void code_counts(struct coder *c, struct par_message *m)
{
    int32_t *count[] = {&m->gone.n, &m->gone_subs.n, &m->n_vertices, &m->n_triangles, &m->n_sides, &m->n_new_subs,
                        &m->n_entries};
    const int64_t left = c->end - c->at, most = c->to || left > TRI_MAX_TRIANGLES ? TRI_MAX_TRIANGLES : left;
    for (size_t k = 0; k < sizeof count / sizeof *count; k++)
        code_below(c, count[k], most);
}

static void code_all(struct coder *c, struct par_message *m)
{
    code_ascending(c, &m->gone, c->triangles);
    code_ascending(c, &m->gone_subs, c->subs);
    code_vertices(c, m);
    code_triangles(c, m);
    code_sides(c, m);
    code_entries(c, m);
}

/* Of what stands before it at the end of a message. */
static uint64_t hash_of(const char *bytes, size_t n) { return tri_hash(n, bytes, n); }

bool par_message_write(struct par_message *m, const struct par_talk *talk, const struct tri_mesh *mesh,
                       int32_t n_common, struct par_bytes *to)
{
    struct coder c = {.to = to, .mesh = mesh, .n_common = n_common, .vertices = talk->vertex.n - m->n_vertices,
                      .triangles = talk->triangle.n - m->n_triangles, .subs = talk->sub.n - m->n_new_subs};
    size_t begin = to->n;
    code_counts(&c, m);
    code_all(&c, m);
    uint64_t hash = c.failed ? 0 : hash_of(to->at + begin, to->n - begin);
    code_bytes(&c, &hash, sizeof hash);
    return !c.failed;
}

static bool reserve_message(struct par_message *m)
{
    return tri_grow(&m->gone.item, &m->gone.capacity, m->gone.n, sizeof *m->gone.item) &&
           tri_grow(&m->gone_subs.item, &m->gone_subs.capacity, m->gone_subs.n, sizeof *m->gone_subs.item) &&
           tri_grow(&m->vertex, &m->vertex_capacity, m->n_vertices, sizeof *m->vertex) &&
           tri_grow(&m->triangle, &m->triangle_capacity, m->n_triangles, sizeof *m->triangle) &&
           tri_grow(&m->side, &m->side_capacity, m->n_sides, sizeof *m->side) &&
           tri_grow(&m->entry, &m->entry_capacity, m->n_entries, sizeof *m->entry);
}

/* Are all old triangles and subsegments that are named still there? */
static bool are_there(const struct par_message *m, const struct par_talk *talk)
{
    bool good = true;
    for (int32_t i = 0; i < m->gone.n; i++)
        good = good && talk->triangle.item[m->gone.item[i]] != TRI_NONE;
    for (int32_t i = 0; i < m->gone_subs.n; i++)
        good = good && talk->sub.item[m->gone_subs.item[i]] != TRI_NONE;
    return good;
}

static void begin_reading(struct coder *c, const struct par_bytes *from)
{
    uint64_t hash;
    size_t n = from->n < sizeof hash ? 0 : from->n - sizeof hash;
    c->at = (const unsigned char *)from->at;
    c->end = c->at + n;
    if (n > 0)
        memcpy(&hash, from->at + n, sizeof hash);
    c->failed = n == 0 || hash != hash_of(from->at, n);
}

enum tri_status par_message_read(struct par_message *m, const struct par_talk *talk, const struct tri_mesh *mesh,
                                 int32_t n_common, const struct par_bytes *from, struct tri_error *error)
{
    struct coder c = {.mesh = mesh, .n_common = n_common, .vertices = talk->vertex.n, .triangles = talk->triangle.n,
                      .subs = talk->sub.n};
    *m = (struct par_message){0};
    begin_reading(&c, from);
    code_counts(&c, m);
    if (!c.failed && !reserve_message(m))
        return par_ranks_no_memory(error);
    if (!c.failed)
        code_all(&c, m);
    if (c.failed || c.at != c.end || !are_there(m, talk))
        return tri_fail(error, TRI_INTERNAL, NULL, 0, "what came from another rank is no part of a mesh");
    return TRI_OK;
}
