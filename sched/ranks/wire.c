/* The encoding of messages. Integers are encoded with seven bits in each byte, lowest bits first. The same functions
 * write and read a message: to code a number means to write it, or to read it if the coder has no output. No function
 * is collective. */
#include "sched/ranks/talk.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/tunables.h"
#include "triangle/base/grow.h"
#include "triangle/base/hash.h"

/* A message that is being written or read. */
struct coder {
    struct par_bytes *to;              /* receives the bytes when writing; NULL: the message is read */
    const unsigned char *at, *end;     /* when reading: the next byte, and the end without the hash */
    bool failed;                       /* writing: no memory; reading: the message is invalid */
    const struct tri_mesh *mesh;       /* its counts of regions and segments limit the valid numbers */
    int32_t n_common;                  /* vertices of the coarse mesh */
    int32_t vertices, triangles, subs; /* first new shared numbers; earlier messages used the lower ones */
};

/* --- numbers */

enum { LONGEST = 16 }; /* maximum length of a number in bytes */

/* Returns the address for the next number, with room for LONGEST bytes; NULL: no memory. */
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

/* Codes any number. */
static void code(struct coder *c, uint64_t *n)
{
    if (c->to)
        put_number(c, *n);
    else
        *n = get_number(c);
}

/* Codes a number from `from` to end - 1. */
static void code_from(struct coder *c, int32_t *n, int32_t from, int64_t end)
{
    uint64_t ahead = c->to ? (uint64_t)(*n - from) : 0;
    code(c, &ahead);
    c->failed = c->failed || end <= from || ahead >= (uint64_t)(end - from);
    *n = c->failed ? 0 : (int32_t)(from + (int64_t)ahead);
}

static void code_below(struct coder *c, int32_t *n, int64_t end) { code_from(c, n, 0, end); }

/* Codes a number from 0 to `from` as from - *n. */
static void code_back(struct coder *c, int32_t *n, int32_t from)
{
    int32_t back = c->to ? from - *n : 0;
    code_below(c, &back, (int64_t)from + 1);
    *n = from - back;
}

/* Codes a signed number of small magnitude: n >= 0 as 2n, and n < 0 as -2n - 1. */
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

/* Codes a number from 0 to end - 1 as its difference from the nearby number `from`. */
static void code_near(struct coder *c, int32_t *n, int32_t from, int32_t end)
{
    int64_t ahead = c->to ? (int64_t)*n - from : 0;
    code_signed(c, &ahead);
    c->failed = c->failed || ahead < -(int64_t)from || ahead >= (int64_t)end - from;
    *n = c->failed ? 0 : (int32_t)(from + ahead);
}

/* Codes the n lowest bytes of a word. Writing always stores eight bytes; the next number overwrites the surplus.
 * Reading always loads eight bytes; it stays inside the message, because the hash of eight bytes follows. */
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

/* Codes a strictly ascending list of numbers below `end` by the gaps between them. */
static void code_ascending(struct coder *c, struct par_ids *list, int32_t end)
{
    for (int32_t i = 0, least = 0; !c->failed && i < list->n; least = list->item[i++] + 1)
        code_from(c, &list->item[i], least, end);
}

/* --- vertices */

/* Kinds of vertices: of the coarse mesh; new, inside, and without a marker; other new vertices. */
enum { COMMON, FREE, OTHER, KINDS };

/* The real numbers of a vertex: two coordinates and a feature size. They are similar to those of the previous vertex,
 * so only the differing bits (XOR) are coded, without leading bytes of zeros. */
enum { REALS = 3, LENGTHS = sizeof(uint64_t) + 1 }; /* a length is 0 to 8 bytes */
struct reals {
    uint64_t bits[REALS]; /* the bit patterns of the doubles */
};

/* Returns the length of a word without leading bytes of zeros. */
static unsigned bytes_in(uint64_t word) { return word ? (unsigned)(71 - __builtin_clzll(word)) / 8 : 0; }

/* Returns the header of a vertex that is not of the coarse mesh: its kind, and the length in bytes of each real number.
 * *differing receives the bits that differ from the previous vertex, *last. */
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

/* Codes the differing bits of a vertex, and sets its coordinates, its feature size and *last from them. */
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

/* The flags of a triangle, coded as one byte before it. A triangle's parent is its first neighbour that precedes it in
 * the same message. The two corners that it shares with its parent are not coded.
 *
 * - bits 0 to 2: the neighbour across this edge has a lower number, which is coded
 * - NEW_APEX: the corner opposite the parent is a new vertex
 * - OTHER_REGION: the region differs from that of the previous triangle
 * - PARENT_EDGE: times this, the edge of the parent that it shares with this triangle
 * - LAST_IS_PARENT: the parent is the previous triangle, and no edge before it has a coded neighbour */
enum { NEW_APEX = 8, OTHER_REGION = 16, PARENT_EDGE = 32, LAST_IS_PARENT = 128 };

/* Returns the edge of t towards its parent; 3: it has no parent. first: the lowest number in the message. */
static int parent_of(const struct par_told_triangle *t, int32_t first)
{
    int e = 0;
    while (e < 3 && (t->next[e] == TRI_NONE || t->next[e] < first))
        e++;
    return e;
}

/* Returns the flags of triangle i. top: the number of the next new vertex. region: the region of triangle i - 1. */
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

/* Codes the neighbours of t. number: the shared number of t. */
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

/* Codes the corners of t. *top: the number of the next new vertex. New vertices are numbered in the order in which the
 * triangles mention them. */
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

/* --- subsegments, worklist entries, and whole messages */

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

/* Codes the numbers of items. When reading, none can exceed the number of remaining bytes, since each item takes at
 * least one byte. This limits the memory that an invalid message can request. */
static void code_counts(struct coder *c, struct par_message *m)
{
    int32_t *count[] = {&m->gone.n, &m->gone_subs.n, &m->n_vertices, &m->n_triangles, &m->n_sides, &m->n_new_subs,
                        &m->n_entries};
    const int64_t left = c->end - c->at, most = c->to || left > TRI_MAX_TRIANGLES ? TRI_MAX_TRIANGLES : left;
    for (size_t k = 0; k < sizeof count / sizeof *count; k++)
        code_below(c, count[k], most);
}

/* Codes everything after the counts. */
static void code_all(struct coder *c, struct par_message *m)
{
    code_ascending(c, &m->gone, c->triangles);
    code_ascending(c, &m->gone_subs, c->subs);
    code_vertices(c, m);
    code_triangles(c, m);
    code_sides(c, m);
    code_entries(c, m);
}

/* Returns the hash of a message, which is appended to it. */
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

/* Makes room for as many items as the counts say. False: no memory. */
static bool reserve_message(struct par_message *m)
{
    return tri_grow(&m->gone.item, &m->gone.capacity, m->gone.n, sizeof *m->gone.item) &&
           tri_grow(&m->gone_subs.item, &m->gone_subs.capacity, m->gone_subs.n, sizeof *m->gone_subs.item) &&
           tri_grow(&m->vertex, &m->vertex_capacity, m->n_vertices, sizeof *m->vertex) &&
           tri_grow(&m->triangle, &m->triangle_capacity, m->n_triangles, sizeof *m->triangle) &&
           tri_grow(&m->side, &m->side_capacity, m->n_sides, sizeof *m->side) &&
           tri_grow(&m->entry, &m->entry_capacity, m->n_entries, sizeof *m->entry);
}

/* Do all deleted triangles and subsegments of the message still exist in the talk? */
static bool are_there(const struct par_message *m, const struct par_talk *talk)
{
    bool good = true;
    for (int32_t i = 0; i < m->gone.n; i++)
        good = good && talk->triangle.item[m->gone.item[i]] != TRI_NONE;
    for (int32_t i = 0; i < m->gone_subs.n; i++)
        good = good && talk->sub.item[m->gone_subs.item[i]] != TRI_NONE;
    return good;
}

/* Sets the range of bytes to read, without the hash, and verifies the hash. */
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
        return tri_fail(error, TRI_INTERNAL, NULL, 0, "another rank has sent an invalid message");
    return TRI_OK;
}
