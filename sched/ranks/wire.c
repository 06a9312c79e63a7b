/* Messages as bytes: whole numbers seven bits at a time, the least first. */
#include "sched/ranks/talk.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/checkpoint/spool.h"
#include "triangle/base/grow.h"

/* --- writing */

/* Of what stands before it at the end of a message. */
static uint64_t hash_of(const char *bytes, size_t n) { return par_hash(n, bytes, n); }

struct writer {
    struct par_bytes *to;
    bool lost;
};

enum { LONGEST = 40, AHEAD = 1 << 12 }; /* bytes of a number, or of a place; so many are reserved at once */

/* Where the next LONGEST bytes may go; NULL: no memory. */
static char *room_for_one(struct writer *w)
{
    struct par_bytes *to = w->to;
    w->lost = w->lost || (to->capacity - to->n < LONGEST && !par_bytes_reserve(to, AHEAD));
    return w->lost ? NULL : to->at + to->n;
}

static char *write_number(char *at, uint64_t n)
{
    for (; n >= 128; n >>= 7)
        *at++ = (char)((n & 127) | 128);
    *at++ = (char)n;
    return at;
}

static void put(struct writer *w, uint64_t n)
{
    char *at = room_for_one(w);
    if (at)
        w->to->n = (size_t)(write_number(at, n) - w->to->at);
}

static void put_byte(struct writer *w, unsigned char byte)
{
    char *at = room_for_one(w);
    if (at) {
        *at = (char)byte;
        w->to->n++;
    }
}

static void put_signed(struct writer *w, int64_t n) { put(w, n < 0 ? 2 * ~(uint64_t)n + 1 : 2 * (uint64_t)n); }

static void put_bytes(struct writer *w, const void *item, size_t n)
{
    w->lost = w->lost || !par_bytes_add(w->to, item, n);
}

/* What lies between one and the next: none comes twice. */
static void put_ascending(struct writer *w, const struct par_ids *list)
{
    for (int32_t i = 0, last = -1; i < list->n; last = list->item[i++])
        put(w, (uint64_t)(list->item[i] - last - 1));
}

enum { COMMON, FREE, OTHER, KINDS };

/* Numbers that go with a place: two coordinates and a size. They differ little from those told before: the bits in
 * which they do are told, without the bytes of zeros in front of them. */
enum { REALS = 3, LENGTHS = sizeof(uint64_t) + 1 };
struct reals {
    uint64_t bits[REALS];
};

static struct reals reals_of(const struct par_told_vertex *v)
{
    const double real[REALS] = {v->xy.x, v->xy.y, v->feature};
    struct reals reals;
    memcpy(&reals, real, sizeof reals);
    return reals;
}

static unsigned bytes_in(uint64_t word) { return word ? (unsigned)(71 - __builtin_clzll(word)) / 8 : 0; }

/* The n lowest of eight bytes; the others are written, too, where what comes next will be. */
static char *write_lowest(char *at, uint64_t word, unsigned n)
{
    for (unsigned k = 0; k < sizeof word; k++)
        at[k] = (char)(word >> 8 * k);
    return at + n;
}

static void put_place(struct writer *w, const struct reals *reals, struct reals *last, unsigned kind)
{
    char *at = room_for_one(w);
    unsigned n[REALS], header = 0;
    for (int k = REALS - 1; k >= 0; k--) {
        last->bits[k] ^= reals->bits[k];
        n[k] = bytes_in(last->bits[k]);
        header = header * LENGTHS + n[k];
    }
    if (at) {
        at = write_number(at, header * KINDS + kind);
        for (int k = 0; k < REALS; k++)
            at = write_lowest(at, last->bits[k], n[k]);
        w->to->n = (size_t)(at - w->to->at);
    }
    *last = *reals;
}

static void put_vertex(struct writer *w, const struct par_told_vertex *v, struct reals *last, const double *attribute,
                       int32_t n)
{
    bool is_free = v->on == TRI_VERTEX_FREE && v->marker == 0;
    if (v->common != TRI_NONE) {
        put(w, COMMON);
        put(w, (uint64_t)v->common);
        return;
    }
    const struct reals reals = reals_of(v);
    put_place(w, &reals, last, is_free ? FREE : OTHER);
    if (!is_free) {
        put_signed(w, v->on);
        put_signed(w, v->marker);
    }
    put_bytes(w, attribute, (size_t)n * sizeof *attribute);
}

static void put_vertices(struct writer *w, const struct par_message *m, int32_t n_attributes)
{
    struct reals last = {{0}};
    for (int32_t i = 0; i < m->n_vertices; i++)
        put_vertex(w, &m->vertex[i], &last, m->attribute + (size_t)i * (size_t)n_attributes, n_attributes);
}

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

/* The edge of a triangle that runs from `from` to `to`, by numbers; -1: none does. */
static int edge_of(const struct par_told_triangle *t, int32_t from, int32_t to)
{
    for (int e = 0; e < 3; e++)
        if (t->v[tri_next[e]] == from && t->v[tri_prev[e]] == to)
            return e;
    return -1;
}

static void put_links(struct writer *w, const struct par_told_triangle *t, int32_t number, bool last_is_parent)
{
    for (int e = 0; e < 3; e++)
        if (t->next[e] != TRI_NONE && !(last_is_parent && t->next[e] == number - 1))
            put(w, (uint64_t)(number - 1 - t->next[e]));
}

static void put_triangle(struct writer *w, const struct par_message *m, int32_t first, int32_t i, int32_t *top,
                         int32_t *region)
{
    const struct par_told_triangle *t = &m->triangle[i];
    int parent = parent_of(t, first), flags = t->region != *region ? OTHER_REGION : 0;
    for (int e = 0; e < 3; e++)
        flags |= (t->next[e] != TRI_NONE) << e;
    if (parent < 3) {
        const struct par_told_triangle *other = &m->triangle[t->next[parent] - first];
        flags |= edge_of(other, t->v[tri_prev[parent]], t->v[tri_next[parent]]) * PARENT_EDGE;
        flags |= t->v[parent] == *top ? NEW_APEX : 0;
        bool is_first = (flags & ((1 << parent) - 1)) == 0;
        flags |= is_first && t->next[parent] == first + i - 1 ? LAST_IS_PARENT : 0;
    }
    put_byte(w, (unsigned char)flags);
    put_links(w, t, first + i, flags & LAST_IS_PARENT);
    for (int k = 0; k < 3; k++) {
        if (parent == 3 || (k == parent && !(flags & NEW_APEX)))
            put(w, (uint64_t)(*top - t->v[k]));
        *top += t->v[k] == *top;
    }
    if (t->region != *region)
        put(w, (uint64_t)(*region = t->region));
}

static void put_triangles(struct writer *w, const struct par_message *m, const struct par_talk *talk)
{
    int32_t top = talk->vertex.n - m->n_vertices, first = talk->triangle.n - m->n_triangles, region = 0;
    for (int32_t i = 0; i < m->n_triangles; i++)
        put_triangle(w, m, first, i, &top, &region);
}

static void put_sides(struct writer *w, const struct par_message *m, const struct par_talk *talk)
{
    int32_t top = talk->sub.n - m->n_new_subs, last = 0;
    for (int32_t i = 0; i < m->n_sides; i++) {
        const struct par_told_side *s = &m->side[i];
        put_signed(w, s->triangle - last);
        put(w, (uint64_t)(s->edge << 2 | s->side << 1 | s->is_boundary));
        put(w, (uint64_t)(top - s->sub));
        if (s->sub == top) {
            put_signed(w, s->marker);
            put(w, (uint64_t)s->parent);
            top++;
        }
        last = s->triangle;
    }
}

static void put_entries(struct writer *w, const struct par_message *m)
{
    uint64_t key = 0;
    int32_t last = 0;
    for (int32_t i = 0; i < m->n_entries; i++) {
        assert(m->entry[i].key >= key);
        put(w, m->entry[i].key - key);
        put_signed(w, m->entry[i].triangle - last);
        key = m->entry[i].key;
        last = m->entry[i].triangle;
    }
}

bool par_message_write(const struct par_message *m, const struct par_talk *talk, int32_t n_attributes,
                       struct par_bytes *to)
{
    struct writer w = {to, false};
    size_t begin = to->n;
    const int32_t count[7] = {m->gone.n, m->gone_subs.n, m->n_vertices, m->n_triangles, m->n_sides, m->n_new_subs,
                              m->n_entries};
    for (int k = 0; k < 7; k++)
        put(&w, (uint64_t)count[k]);
    put_ascending(&w, &m->gone);
    put_ascending(&w, &m->gone_subs);
    put_vertices(&w, m, n_attributes);
    put_triangles(&w, m, talk);
    put_sides(&w, m, talk);
    put_entries(&w, m);
    uint64_t hash = w.lost ? 0 : hash_of(to->at + begin, to->n - begin);
    put_bytes(&w, &hash, sizeof hash);
    return !w.lost;
}

/* --- reading */

struct reader {
    const unsigned char *at, *end;
    bool bad;
};

static uint64_t get(struct reader *r)
{
    uint64_t n = 0;
    for (int shift = 0; shift < 64 && r->at < r->end; shift += 7) {
        unsigned char byte = *r->at++;
        n |= (uint64_t)(byte & 127) << shift;
        if (byte < 128)
            return n;
    }
    r->bad = true;
    return 0;
}

/* A number from 0 to end - 1. */
static int32_t get_below(struct reader *r, int64_t end)
{
    uint64_t n = get(r);
    r->bad = r->bad || end <= 0 || n >= (uint64_t)end;
    return r->bad ? 0 : (int32_t)n;
}

static int64_t get_signed(struct reader *r)
{
    uint64_t n = get(r);
    return n % 2 ? ~(int64_t)(n / 2) : (int64_t)(n / 2);
}

/* A number from 0 to end - 1, told as its difference from another. */
static int32_t get_near(struct reader *r, int32_t from, int32_t end)
{
    int64_t n = get_signed(r);
    r->bad = r->bad || n < -(int64_t)from || n >= (int64_t)end - from;
    return r->bad ? 0 : (int32_t)(from + n);
}

static int32_t get_int(struct reader *r) { return (int32_t)get_signed(r); }

static void get_bytes(struct reader *r, void *item, size_t n)
{
    r->bad = r->bad || (size_t)(r->end - r->at) < n;
    if (r->bad || n == 0)
        return;
    memcpy(item, r->at, n);
    r->at += n;
}

static void get_ascending(struct reader *r, struct par_ids *list, int32_t n, int32_t end)
{
    for (int32_t last = -1; !r->bad && list->n < n; last = list->item[list->n++])
        list->item[list->n] = last + 1 + get_below(r, (int64_t)end - last - 1);
}

/* Eight bytes lie behind whatever may be read (the hash), so that a word can be, of which the n lowest count. */
static uint64_t get_lowest(struct reader *r, unsigned n)
{
    uint64_t word = 0;
    r->bad = r->bad || (size_t)(r->end - r->at) < n;
    if (r->bad || n == 0)
        return 0;
    for (unsigned k = 0; k < sizeof word; k++)
        word |= (uint64_t)r->at[k] << 8 * k;
    r->at += n;
    return word & UINT64_MAX >> 8 * (sizeof word - n);
}

static void get_place(struct reader *r, struct par_told_vertex *v, struct reals *last, unsigned header)
{
    double real[REALS];
    for (int k = 0; k < REALS; k++, header /= LENGTHS)
        last->bits[k] ^= get_lowest(r, header % LENGTHS);
    memcpy(real, last, sizeof real);
    v->xy = (struct tri_point){real[0], real[1]};
    v->feature = real[2];
}

static void get_vertex(struct reader *r, struct par_told_vertex *v, struct reals *last, double *attribute, int32_t n,
                       int32_t n_common)
{
    const unsigned header = (unsigned)get_below(r, KINDS * LENGTHS * LENGTHS * LENGTHS), kind = header % KINDS;
    *v = (struct par_told_vertex){.common = TRI_NONE, .on = TRI_VERTEX_FREE};
    if (kind == COMMON) {
        v->common = get_below(r, n_common);
        r->bad = r->bad || header != COMMON;
        return;
    }
    get_place(r, v, last, header / KINDS);
    if (kind == OTHER) {
        v->on = get_int(r);
        v->marker = get_int(r);
    }
    get_bytes(r, attribute, (size_t)n * sizeof *attribute);
}

static void get_vertices(struct reader *r, struct par_message *m, int32_t n_attributes, int32_t n_common)
{
    struct reals last = {{0}};
    for (int32_t i = 0; !r->bad && i < m->n_vertices; i++)
        get_vertex(r, &m->vertex[i], &last, m->attribute + (size_t)i * (size_t)n_attributes, n_attributes, n_common);
}

static void get_links(struct reader *r, struct par_told_triangle *t, int32_t number, int flags)
{
    bool last_is_parent = flags & LAST_IS_PARENT;
    for (int e = 0; e < 3; e++) {
        t->next[e] = TRI_NONE;
        if (!(flags >> e & 1))
            continue;
        t->next[e] = last_is_parent ? number - 1 : number - 1 - get_below(r, number);
        last_is_parent = false;
    }
}

static void get_triangle(struct reader *r, struct par_message *m, int32_t first, int32_t i, int32_t *top,
                         int32_t n_regions)
{
    struct par_told_triangle *t = &m->triangle[i];
    int flags = (int)get_lowest(r, 1);
    r->bad = r->bad || (i == 0 && flags & LAST_IS_PARENT);
    if (r->bad)
        return;
    get_links(r, t, first + i, flags);
    int parent = parent_of(t, first), edge = flags / PARENT_EDGE % 4;
    r->bad = r->bad || edge == 3;
    if (r->bad)
        return;
    if (parent < 3) {
        const struct par_told_triangle *other = &m->triangle[t->next[parent] - first];
        t->v[tri_prev[parent]] = other->v[tri_next[edge]];
        t->v[tri_next[parent]] = other->v[tri_prev[edge]];
    }
    for (int k = 0; k < 3; k++) {
        if (parent == 3 || (k == parent && !(flags & NEW_APEX)))
            t->v[k] = *top - get_below(r, (int64_t)*top + 1);
        else if (k == parent)
            t->v[k] = *top;
        *top += t->v[k] == *top;
    }
    t->region = flags & OTHER_REGION ? get_below(r, n_regions) : i > 0 ? m->triangle[i - 1].region : 0;
}

static void get_triangles(struct reader *r, struct par_message *m, const struct par_talk *talk, int32_t n_regions)
{
    int32_t top = talk->vertex.n;
    for (int32_t i = 0; !r->bad && i < m->n_triangles; i++)
        get_triangle(r, m, talk->triangle.n, i, &top, n_regions);
    r->bad = r->bad || top != talk->vertex.n + m->n_vertices;
}

static void get_sides(struct reader *r, struct par_message *m, const struct par_talk *talk, int32_t n_parents)
{
    int32_t top = talk->sub.n, end = talk->sub.n + m->n_new_subs, triangles = talk->triangle.n + m->n_triangles;
    int32_t last = 0;
    for (int32_t i = 0; i < m->n_sides; i++) {
        struct par_told_side *s = &m->side[i];
        s->triangle = last = get_near(r, last, triangles);
        int32_t flags = get_below(r, 3 << 2);
        s->edge = flags >> 2;
        s->side = flags >> 1 & 1;
        s->is_boundary = flags & 1;
        s->sub = top - get_below(r, (int64_t)top + 1);
        s->marker = s->parent = 0;
        if (s->sub < top)
            continue;
        s->marker = get_int(r);
        s->parent = get_below(r, n_parents);
        r->bad = r->bad || top++ >= end;
    }
    r->bad = r->bad || top != end;
}

static void get_entries(struct reader *r, struct par_message *m, int32_t triangles)
{
    uint64_t key = 0;
    int32_t last = 0;
    for (int32_t i = 0; i < m->n_entries; i++) {
        key += get(r);
        m->entry[i] = (struct par_told_entry){key, last = get_near(r, last, triangles)};
    }
}

static bool reserve(struct par_message *m, const int32_t count[7], int32_t n_attributes)
{
    m->n_vertices = count[2];
    m->n_triangles = count[3];
    m->n_sides = count[4];
    m->n_new_subs = count[5];
    m->n_entries = count[6];
    int32_t values = par_values_of(count[2], n_attributes);
    return values >= 0 && tri_grow(&m->gone.item, &m->gone.capacity, count[0], sizeof *m->gone.item) &&
           tri_grow(&m->gone_subs.item, &m->gone_subs.capacity, count[1], sizeof *m->gone_subs.item) &&
           tri_grow(&m->vertex, &m->vertex_capacity, count[2], sizeof *m->vertex) &&
           tri_grow(&m->attribute, &m->attribute_capacity, values, sizeof *m->attribute) &&
           tri_grow(&m->triangle, &m->triangle_capacity, count[3], sizeof *m->triangle) &&
           tri_grow(&m->side, &m->side_capacity, count[4], sizeof *m->side) &&
           tri_grow(&m->entry, &m->entry_capacity, count[6], sizeof *m->entry);
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

static void begin(struct reader *r, const struct par_bytes *from)
{
    uint64_t hash;
    size_t n = from->n < sizeof hash ? 0 : from->n - sizeof hash;
    r->at = (const unsigned char *)from->at;
    r->end = r->at + n;
    if (n > 0)
        memcpy(&hash, from->at + n, sizeof hash);
    r->bad = n == 0 || hash != hash_of(from->at, n);
}

enum tri_status par_message_read(struct par_message *m, const struct par_talk *talk, const struct tri_mesh *mesh,
                                 int32_t n_common, const struct par_bytes *from, struct tri_error *error)
{
    struct reader r = {0};
    int32_t count[7] = {0}, n = mesh->n_attributes;
    const int64_t most = from->n < TRI_MAX_TRIANGLES ? (int64_t)from->n : TRI_MAX_TRIANGLES;
    *m = (struct par_message){0};
    begin(&r, from);
    for (int k = 0; !r.bad && k < 7; k++)
        count[k] = get_below(&r, most); /* each takes a byte at least */
    if (!r.bad && !reserve(m, count, n))
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for what lies at the border of ranks");
    if (!r.bad) {
        get_ascending(&r, &m->gone, count[0], talk->triangle.n);
        get_ascending(&r, &m->gone_subs, count[1], talk->sub.n);
        get_vertices(&r, m, n, n_common);
        get_triangles(&r, m, talk, mesh->n_regions);
        get_sides(&r, m, talk, mesh->n_parents);
        get_entries(&r, m, talk->triangle.n + m->n_triangles);
    }
    if (r.bad || r.at != r.end || !are_there(m, talk))
        return tri_fail(error, TRI_INTERNAL, NULL, 0, "what came from another rank is no part of a mesh");
    return TRI_OK;
}
