/* Layout of a fragment: header; keys of entries; places, feature sizes and attributes of fresh vertices; then numbers
 * of 32 bits: the common vertices, kinds and markers of the fresh ones, triangles, subsegments, entries; filled up to
 * eight bytes. Vertices within a fragment are counted from 0, the common ones first. */
#include "sched/ranks/fragment.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/grow.h"

static const uint64_t MAGIC = 0x70746672616731ull; /* also tells the order of bytes */

struct header {
    uint64_t magic, bytes, hash; /* the hash is that of all that follows it */
    struct tri_fence box;
    int32_t n_common, n_attributes;
    int32_t n_named, n_fresh, n_triangles, n_subs, n_entries, unused;
};

struct wire_triangle {
    int32_t v[3], region;
};

struct wire_sub {
    int32_t v[2], marker, parent;
};

/* Where the parts of a fragment lie. */
struct parts {
    uint64_t *keys;
    struct tri_point *xy;
    double *feature, *attributes;
    int32_t *named, *on, *markers;
    struct wire_triangle *triangles;
    struct wire_sub *subs;
    int32_t *entries;
    size_t bytes;
};

static void *place(char *bytes, size_t *at, int32_t n, size_t item)
{
    void *here = bytes + *at;
    *at += (size_t)n * item;
    return here;
}

static struct parts parts_of(const struct header *h, char *bytes)
{
    struct parts p;
    size_t at = sizeof *h;
    p.keys = place(bytes, &at, h->n_entries, sizeof *p.keys);
    p.xy = place(bytes, &at, h->n_fresh, sizeof *p.xy);
    p.feature = place(bytes, &at, h->n_fresh, sizeof *p.feature);
    p.attributes = place(bytes, &at, h->n_fresh, (size_t)h->n_attributes * sizeof *p.attributes);
    p.named = place(bytes, &at, h->n_named, sizeof *p.named);
    p.on = place(bytes, &at, h->n_fresh, sizeof *p.on);
    p.markers = place(bytes, &at, h->n_fresh, sizeof *p.markers);
    p.triangles = place(bytes, &at, h->n_triangles, sizeof *p.triangles);
    p.subs = place(bytes, &at, h->n_subs, sizeof *p.subs);
    p.entries = place(bytes, &at, h->n_entries, sizeof *p.entries);
    p.bytes = (at + 7) / 8 * 8;
    return p;
}

static uint64_t mixed(uint64_t word)
{
    word = (word ^ word >> 31) * 0x9e3779b97f4a7c15ull;
    return word ^ word >> 29;
}

/* Of a fragment of n bytes. */
static uint64_t hash_of(const char *bytes, size_t n)
{
    uint64_t hash = n, word;
    for (size_t i = offsetof(struct header, box); i + sizeof word <= n; i += sizeof word) {
        memcpy(&word, bytes + i, sizeof word);
        hash = mixed(hash ^ word);
    }
    return hash;
}

static bool touches(const struct tri_mesh *mesh, const struct tri_triangle *t, const struct tri_fence *box)
{
    return tri_is_live(t) && (tri_fence_holds(box, mesh->xy[t->v[0]]) || tri_fence_holds(box, mesh->xy[t->v[1]]) ||
                              tri_fence_holds(box, mesh->xy[t->v[2]]));
}

/* Which vertices lie in a box: one bit each, so that all of them stay in the cache while triangles are looked at. */
struct inside {
    uint64_t *word;
};

static bool inside_init(struct inside *inside, const struct tri_mesh *mesh, const struct tri_fence *box)
{
    inside->word = calloc((size_t)mesh->n_vertices / 64 + 1, sizeof *inside->word);
    for (int32_t v = 0; inside->word && v < mesh->n_vertices; v++)
        inside->word[v / 64] |= (uint64_t)tri_fence_holds(box, mesh->xy[v]) << v % 64;
    return inside->word;
}

static inline uint64_t is_inside(const struct inside *inside, int32_t v) { return inside->word[v / 64] >> v % 64 & 1; }

/* Has the triangle a corner in the box? */
static inline bool reaches_in(const struct inside *inside, const struct tri_triangle *t)
{
    return tri_is_live(t) &&
           (is_inside(inside, t->v[0]) | is_inside(inside, t->v[1]) | is_inside(inside, t->v[2])) != 0;
}

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for what lies at the border of ranks");
}

/* --- the worklist */

bool par_keys_tell(struct par_state *state)
{
    struct par_keys *key = &state->key;
    if (key->n == state->worklist.n)
        return true;
    assert(key->n == 0);
    if (!tri_grow(&key->item, &key->capacity, state->worklist.n, sizeof *key->item))
        return false;
    for (; key->n < state->worklist.n; key->n++)
        key->item[key->n] = (uint64_t)key->n;
    return true;
}

void par_worklist_keep(struct par_state *state, const struct tri_fence *box)
{
    int32_t kept = 0;
    assert(state->key.n == state->worklist.n);
    for (int32_t i = 0; i < state->worklist.n; i++)
        if (touches(state->mesh, &state->mesh->tri[state->worklist.item[i]], box)) {
            state->key.item[kept] = state->key.item[i];
            state->worklist.item[kept++] = state->worklist.item[i];
        }
    state->worklist.n = state->key.n = kept;
}

/* --- cut */

struct cutting {
    const struct par_state *state;
    const struct tri_mesh *mesh;
    struct header header;
    struct inside inside;
    int32_t *index;                  /* [n_vertices] in its list, + 1; 0: in none */
    struct par_worklist named, fresh; /* vertices */
    struct par_worklist triangles, subs; /* ids, the first ascending */
};

static bool add_vertex(struct cutting *c, int32_t v)
{
    struct par_worklist *list = v < c->header.n_common ? &c->named : &c->fresh;
    if (c->index[v] > 0)
        return true;
    c->index[v] = list->n + 1;
    return par_worklist_add(list, v);
}

/* Is this triangle the one that takes the subsegment along: the left one, if that comes along? */
static bool takes_sub(const struct cutting *c, int32_t t, const struct tri_subsegment *s)
{
    int32_t left = s->side[0] == TRI_NONE ? TRI_NONE : tri_of(s->side[0]);
    return left == t || left == TRI_NONE || !reaches_in(&c->inside, &c->mesh->tri[left]);
}

static bool find_all(struct cutting *c)
{
    const struct tri_mesh *mesh = c->mesh;
    bool memory = true;
    for (int32_t t = 0; memory && t < mesh->n_triangles; t++) {
        const struct tri_triangle *triangle = &mesh->tri[t];
        if (!reaches_in(&c->inside, triangle))
            continue;
        memory = par_worklist_add(&c->triangles, t);
        for (int k = 0; memory && k < 3; k++) {
            memory = add_vertex(c, triangle->v[k]);
            if (memory && triangle->n[k] < 0 && triangle->n[k] != PAR_BEYOND &&
                takes_sub(c, t, &mesh->sub[~triangle->n[k]]))
                memory = par_worklist_add(&c->subs, ~triangle->n[k]);
        }
    }
    return memory;
}

static int32_t wire_vertex(const struct cutting *c, int32_t v)
{
    assert(c->index[v] > 0);
    return c->index[v] - 1 + (v < c->header.n_common ? 0 : c->named.n);
}

static void write_vertices(const struct cutting *c, const struct parts *p)
{
    const struct tri_mesh *mesh = c->mesh;
    size_t n = (size_t)mesh->n_attributes;
    for (int32_t i = 0; i < c->named.n; i++)
        p->named[i] = c->named.item[i];
    for (int32_t i = 0; i < c->fresh.n; i++) {
        int32_t v = c->fresh.item[i];
        p->xy[i] = mesh->xy[v];
        p->feature[i] = mesh->feature[v];
        p->on[i] = mesh->on[v];
        p->markers[i] = mesh->vertex_markers[v];
        if (n > 0)
            memcpy(p->attributes + (size_t)i * n, mesh->attributes + (size_t)v * n, n * sizeof *p->attributes);
    }
}

static void write_triangles(const struct cutting *c, const struct parts *p)
{
    for (int32_t i = 0; i < c->triangles.n; i++) {
        const struct tri_triangle *t = &c->mesh->tri[c->triangles.item[i]];
        p->triangles[i] = (struct wire_triangle){
            {wire_vertex(c, t->v[0]), wire_vertex(c, t->v[1]), wire_vertex(c, t->v[2])}, t->region};
    }
    for (int32_t i = 0; i < c->subs.n; i++) {
        const struct tri_subsegment *s = &c->mesh->sub[c->subs.item[i]];
        p->subs[i] = (struct wire_sub){{wire_vertex(c, s->v[0]), wire_vertex(c, s->v[1])}, s->marker, s->parent};
    }
}

/* The place of an entry of the worklist among the triangles; TRI_NONE: it is not there. */
static int32_t entry_at(const struct cutting *c, int32_t i)
{
    int32_t triangle = c->state->worklist.item[i], at = par_worklist_find(&c->triangles, triangle);
    return at < c->triangles.n && c->triangles.item[at] == triangle ? at : TRI_NONE;
}

static void write_entries(const struct cutting *c, const struct parts *p)
{
    int32_t n = 0;
    for (int32_t i = 0; i < c->state->worklist.n; i++) {
        int32_t at = entry_at(c, i);
        if (at == TRI_NONE)
            continue;
        p->keys[n] = c->state->key.item[i];
        p->entries[n++] = at;
    }
    assert(n == c->header.n_entries);
}

static bool write_all(struct cutting *c, struct par_bytes *to)
{
    struct header *h = &c->header;
    h->n_named = c->named.n;
    h->n_fresh = c->fresh.n;
    h->n_triangles = c->triangles.n;
    h->n_subs = c->subs.n;
    for (int32_t i = 0; i < c->state->worklist.n; i++)
        h->n_entries += entry_at(c, i) != TRI_NONE;
    h->bytes = parts_of(h, (char *)h).bytes; /* their sizes alone */
    if (!par_bytes_reserve(to, h->bytes))
        return false;
    char *bytes = to->at + to->n;
    const struct parts p = parts_of(h, bytes);
    memset(bytes + h->bytes - 8, 0, 8); /* what fills it up */
    write_vertices(c, &p);
    write_triangles(c, &p);
    write_entries(c, &p);
    memcpy(bytes, h, sizeof *h);
    h->hash = hash_of(bytes, h->bytes);
    memcpy(bytes, h, sizeof *h);
    to->n += h->bytes;
    return true;
}

enum tri_status par_fragment_cut(struct par_bytes *to, const struct par_state *state, int32_t n_common,
                                 const struct tri_fence *box, struct tri_error *error)
{
    struct cutting c = {.state = state, .mesh = state->mesh};
    c.header = (struct header){.magic = MAGIC, .box = *box, .n_common = n_common,
                               .n_attributes = state->mesh->n_attributes};
    assert(state->key.n == state->worklist.n);
    par_room_mark(&state->spare, state->mesh);
    c.index = calloc((size_t)state->mesh->n_vertices + 1, sizeof *c.index);
    bool done = c.index && inside_init(&c.inside, c.mesh, box) && find_all(&c) && write_all(&c, to);
    free(c.index);
    free(c.inside.word);
    free(c.named.item);
    free(c.fresh.item);
    free(c.triangles.item);
    free(c.subs.item);
    return done ? TRI_OK : no_memory(error);
}

/* --- tables for pasting */

/* From keys that are not 0 to numbers; open addressing, at most half full. */
struct table {
    uint64_t *key;
    int32_t *value;
    size_t mask;
};

static bool table_init(struct table *table, size_t n)
{
    size_t size = 16;
    while (size < 2 * n)
        size *= 2;
    table->mask = size - 1;
    table->key = calloc(size, sizeof *table->key);
    table->value = malloc(size * sizeof *table->value);
    return table->key && table->value;
}

static void table_free(struct table *table)
{
    free(table->key);
    free(table->value);
}

/* Where the key is, or may be put: its value then is the caller's to set. */
static size_t table_find(const struct table *table, uint64_t key)
{
    size_t at = mixed(key) & table->mask;
    while (table->key[at] != 0 && table->key[at] != key)
        at = (at + 1) & table->mask;
    return at;
}

static uint64_t edge_key(int32_t a, int32_t b)
{
    uint64_t low = (uint64_t)(a < b ? a : b), high = (uint64_t)(a < b ? b : a);
    return high << 32 | low; /* not 0: the ends differ */
}

static uint64_t place_key(struct tri_point q)
{
    uint64_t bits[2];
    memcpy(bits, &q, sizeof bits);
    return mixed(mixed(bits[0]) + bits[1]) | 1;
}

/* --- paste */

struct pasting {
    struct par_state *state;
    struct tri_mesh *mesh;
    const struct header *header;
    struct parts parts;
    struct inside inside;
    struct par_worklist doomed;      /* triangles that go, ascending */
    struct par_worklist doomed_subs; /* subsegments with nothing on either side once they have gone .. */
    int32_t n_subs_used;             /* .. of which so many numbers are in use again */
    struct par_worklist open_subs;   /* with a triangle on one side that stays */
    struct par_worklist rim;         /* edges of what stays that lead to what goes, or beyond */
    struct table edges;              /* to the code of an edge that has no partner yet, or to ~subsegment */
    struct table places;             /* of the doomed triangles' vertices: to their ids, ~id: still there afterwards */
    int32_t n_places;
    struct par_worklist doomed_vertices; /* that are not */
    struct par_worklist entries;
    struct par_keys keys;
    int32_t *vertex;                 /* [n_named + n_fresh] ids here */
};

static bool is_doomed(const struct pasting *p, int32_t code)
{
    return code >= 0 && reaches_in(&p->inside, &p->mesh->tri[tri_of(code)]);
}

/* A triangle goes: those beside it that stay are at the rim. */
static bool doom(struct pasting *p, int32_t t)
{
    bool memory = par_worklist_add(&p->doomed, t);
    for (int e = 0; memory && e < 3; e++) {
        int32_t link = p->mesh->tri[t].n[e];
        bool is_mutual = link >= 0 && p->mesh->tri[tri_of(link)].n[tri_edge(link)] == tri_code(t, e);
        if (is_mutual && !is_doomed(p, link))
            memory = par_worklist_add(&p->rim, link);
    }
    return memory;
}

static bool find_doomed(struct pasting *p)
{
    const struct tri_mesh *mesh = p->mesh;
    bool memory = true;
    for (int32_t t = 0; memory && t < mesh->n_triangles; t++) {
        const struct tri_triangle *triangle = &mesh->tri[t];
        if (reaches_in(&p->inside, triangle))
            memory = doom(p, t);
        else if (tri_is_live(triangle))
            for (int e = 0; memory && e < 3; e++)
                if (triangle->n[e] == PAR_BEYOND)
                    memory = par_worklist_add(&p->rim, tri_code(t, e));
    }
    for (int32_t s = 0; memory && s < mesh->n_subs; s++) {
        const struct tri_subsegment *sub = &mesh->sub[s];
        if (sub->v[0] == TRI_NONE)
            continue;
        bool left = sub->side[0] != TRI_NONE, right = sub->side[1] != TRI_NONE;
        bool keeps_left = left && !is_doomed(p, sub->side[0]), keeps_right = right && !is_doomed(p, sub->side[1]);
        if (!keeps_left && !keeps_right)
            memory = par_worklist_add(&p->doomed_subs, s);
        else if (!keeps_left || !keeps_right)
            memory = par_worklist_add(&p->open_subs, s);
    }
    return memory;
}

/* Entries of triangles that stay, and those of the fragment as ~their places there, by their keys. */
static void merge_entries(struct pasting *p)
{
    const struct par_worklist *own = &p->state->worklist;
    const uint64_t *own_key = p->state->key.item, *key = p->parts.keys;
    int32_t n = 0;
    for (int32_t i = 0, k = 0; i < own->n || k < p->header->n_entries;) {
        if (k == p->header->n_entries || (i < own->n && own_key[i] < key[k])) {
            if (!reaches_in(&p->inside, &p->mesh->tri[own->item[i]])) {
                p->entries.item[n] = own->item[i];
                p->keys.item[n++] = own_key[i];
            }
            i++;
        } else {
            p->entries.item[n] = ~p->parts.entries[k];
            p->keys.item[n++] = key[k++];
        }
    }
    p->entries.n = p->keys.n = n;
}

static int32_t find_place(const struct pasting *p, struct tri_point q, size_t *at)
{
    const struct table *places = &p->places;
    for (*at = mixed(place_key(q)) & places->mask; places->key[*at] != 0; *at = (*at + 1) & places->mask) {
        int32_t v = places->value[*at];
        if (v >= 0 && p->mesh->xy[v].x == q.x && p->mesh->xy[v].y == q.y)
            return v;
    }
    return TRI_NONE;
}

static void note_places(struct pasting *p)
{
    size_t at;
    for (int32_t i = 0; i < p->doomed.n; i++)
        for (int k = 0; k < 3; k++) {
            int32_t v = p->mesh->tri[p->doomed.item[i]].v[k];
            if (v < p->header->n_common || find_place(p, p->mesh->xy[v], &at) != TRI_NONE)
                continue;
            p->places.key[at] = place_key(p->mesh->xy[v]);
            p->places.value[at] = v;
            p->n_places++;
        }
}

static bool reserve_ranges(struct par_room *spare, enum par_kind kind, int32_t more)
{
    struct par_ranges *ranges = &spare->ranges[kind];
    return par_ranges_reserve(ranges, ranges->n + ranges->dealt + more);
}

static bool reserve_all(struct pasting *p)
{
    const struct header *h = p->header;
    struct par_room *spare = &p->state->spare;
    size_t edges = 3 * (size_t)h->n_triangles + (size_t)p->rim.n + (size_t)h->n_subs + (size_t)p->open_subs.n;
    int32_t entries = p->state->worklist.n + h->n_entries;
    if (!table_init(&p->edges, edges) || !table_init(&p->places, 3 * (size_t)p->doomed.n))
        return false;
    note_places(p);
    p->vertex = malloc(((size_t)h->n_named + (size_t)h->n_fresh + 1) * sizeof *p->vertex);
    return p->vertex && tri_grow(&p->entries.item, &p->entries.capacity, entries, sizeof *p->entries.item) &&
           tri_grow(&p->keys.item, &p->keys.capacity, entries, sizeof *p->keys.item) &&
           tri_grow(&p->doomed_vertices.item, &p->doomed_vertices.capacity, p->n_places,
                    sizeof *p->doomed_vertices.item) &&
           reserve_ranges(spare, PAR_VERTICES, p->n_places) && reserve_ranges(spare, PAR_TRIANGLES, p->doomed.n) &&
           reserve_ranges(spare, PAR_SUBS, p->doomed_subs.n);
}

static int32_t append_vertex(struct pasting *p, int32_t i)
{
    struct tri_mesh *mesh = p->mesh;
    int32_t v = mesh->n_vertices++;
    size_t n = (size_t)mesh->n_attributes;
    mesh->xy[v] = p->parts.xy[i];
    mesh->feature[v] = p->parts.feature[i];
    mesh->on[v] = p->parts.on[i];
    mesh->vertex_markers[v] = p->parts.markers[i];
    if (n > 0)
        memcpy(mesh->attributes + (size_t)v * n, p->parts.attributes + (size_t)i * n, n * sizeof *mesh->attributes);
    return v;
}

static void paste_vertices(struct pasting *p)
{
    size_t at;
    for (int32_t i = 0; i < p->header->n_named; i++)
        p->vertex[i] = p->parts.named[i];
    for (int32_t i = 0; i < p->header->n_fresh; i++) {
        int32_t v = find_place(p, p->parts.xy[i], &at);
        p->vertex[p->header->n_named + i] = v == TRI_NONE ? append_vertex(p, i) : v;
        if (v != TRI_NONE)
            p->places.value[at] = ~v;
    }
}

/* Vertices in the box that the fragment does not know have gone with their triangles. */
static void drop_vertices(struct pasting *p)
{
    struct par_worklist *doomed = &p->doomed_vertices;
    for (size_t at = 0; at <= p->places.mask; at++)
        if (p->places.key[at] != 0 && p->places.value[at] >= 0 && is_inside(&p->inside, p->places.value[at]))
            doomed->item[doomed->n++] = p->places.value[at];
    doomed->n = par_sort_unique(doomed->item, doomed->n);
    for (int32_t i = 0; i < doomed->n; i++)
        p->mesh->on[doomed->item[i]] = TRI_VERTEX_NONE;
}

static void cut_loose(struct pasting *p)
{
    struct tri_mesh *mesh = p->mesh;
    for (int32_t i = 0; i < p->open_subs.n; i++) {
        struct tri_subsegment *s = &mesh->sub[p->open_subs.item[i]];
        for (int side = 0; side < 2; side++)
            if (is_doomed(p, s->side[side]))
                s->side[side] = TRI_NONE;
    }
    for (int32_t i = 0; i < p->rim.n; i++)
        mesh->tri[tri_of(p->rim.item[i])].n[tri_edge(p->rim.item[i])] = PAR_BEYOND;
    for (int32_t i = 0; i < p->doomed_subs.n; i++)
        par_room_mark_sub(mesh, p->doomed_subs.item[i]);
}

static void note_edge(struct pasting *p, int32_t a, int32_t b, int32_t value)
{
    size_t at = table_find(&p->edges, edge_key(a, b));
    p->edges.key[at] = edge_key(a, b);
    p->edges.value[at] = value;
}

static void note_rim(struct pasting *p)
{
    for (int32_t i = 0; i < p->rim.n; i++) {
        const struct tri_triangle *t = &p->mesh->tri[tri_of(p->rim.item[i])];
        int e = tri_edge(p->rim.item[i]);
        note_edge(p, t->v[tri_next[e]], t->v[tri_prev[e]], p->rim.item[i]);
    }
    for (int32_t i = 0; i < p->open_subs.n; i++) {
        const struct tri_subsegment *s = &p->mesh->sub[p->open_subs.item[i]];
        note_edge(p, s->v[0], s->v[1], ~p->open_subs.item[i]);
    }
}

/* A subsegment of which one side has stayed is there already. */
static void paste_subs(struct pasting *p)
{
    int32_t used = 0;
    for (int32_t i = 0; i < p->header->n_subs; i++) {
        const struct wire_sub *wire = &p->parts.subs[i];
        int32_t a = p->vertex[wire->v[0]], b = p->vertex[wire->v[1]];
        size_t at = table_find(&p->edges, edge_key(a, b));
        if (p->edges.key[at] != 0 && p->edges.value[at] < 0)
            continue;
        int32_t s = used < p->doomed_subs.n ? p->doomed_subs.item[used++] : p->mesh->n_subs++;
        p->mesh->sub[s] = (struct tri_subsegment){{a, b}, {TRI_NONE, TRI_NONE}, wire->marker, wire->parent};
        note_edge(p, a, b, ~s);
    }
    p->n_subs_used = used;
}

static void link_edge(struct pasting *p, int32_t code)
{
    struct tri_mesh *mesh = p->mesh;
    struct tri_triangle *t = &mesh->tri[tri_of(code)];
    int e = tri_edge(code);
    int32_t from = t->v[tri_next[e]], to = t->v[tri_prev[e]];
    size_t at = table_find(&p->edges, edge_key(from, to));
    t->n[e] = PAR_BEYOND;
    if (p->edges.key[at] == 0) {
        p->edges.key[at] = edge_key(from, to);
        p->edges.value[at] = code;
        return;
    }
    int32_t other = p->edges.value[at];
    t->n[e] = other;
    if (other < 0)
        mesh->sub[~other].side[tri_side(&mesh->sub[~other], from)] = code;
    else
        mesh->tri[tri_of(other)].n[tri_edge(other)] = code;
}

/* In the numbers of those that have gone, then in new ones. */
static int32_t slot_of(const struct pasting *p, int32_t i, int32_t n_triangles)
{
    return i < p->doomed.n ? p->doomed.item[i] : n_triangles + i - p->doomed.n;
}

static void paste_triangles(struct pasting *p)
{
    struct tri_mesh *mesh = p->mesh;
    int32_t before = mesh->n_triangles, n = p->header->n_triangles;
    mesh->n_triangles += n > p->doomed.n ? n - p->doomed.n : 0;
    for (int32_t i = 0; i < n; i++) {
        const struct wire_triangle *wire = &p->parts.triangles[i];
        mesh->tri[slot_of(p, i, before)] = (struct tri_triangle){
            {p->vertex[wire->v[0]], p->vertex[wire->v[1]], p->vertex[wire->v[2]]},
            {PAR_BEYOND, PAR_BEYOND, PAR_BEYOND}, wire->region, 0};
    }
    for (int32_t i = 0; i < n; i++)
        for (int e = 0; e < 3; e++)
            link_edge(p, tri_code(slot_of(p, i, before), e));
    for (int32_t i = n; i < p->doomed.n; i++)
        mesh->tri[p->doomed.item[i]].v[0] = TRI_NONE;
    for (int32_t i = 0; i < p->entries.n; i++)
        if (p->entries.item[i] < 0)
            p->entries.item[i] = slot_of(p, ~p->entries.item[i], before);
}

/* Numbers item[first] to item[n - 1]. */
static void give_back(struct par_ranges *to, const int32_t *item, int32_t first, int32_t n)
{
    for (int32_t end; first < n; first = end) {
        for (end = first + 1; end < n && item[end] == item[end - 1] + 1;)
            end++;
        to->item[to->n++] = (struct par_range){item[first], item[end - 1] + 1};
    }
    assert(to->n + to->dealt <= to->capacity);
}

/* Nothing here can fail. */
static void replace(struct pasting *p)
{
    struct par_state *state = p->state;
    int32_t n = p->header->n_triangles < p->doomed.n ? p->header->n_triangles : p->doomed.n;
    merge_entries(p);
    paste_vertices(p);
    drop_vertices(p);
    cut_loose(p);
    note_rim(p);
    paste_subs(p);
    paste_triangles(p);
    give_back(&state->spare.ranges[PAR_TRIANGLES], p->doomed.item, n, p->doomed.n);
    give_back(&state->spare.ranges[PAR_VERTICES], p->doomed_vertices.item, 0, p->doomed_vertices.n);
    give_back(&state->spare.ranges[PAR_SUBS], p->doomed_subs.item, p->n_subs_used, p->doomed_subs.n);
    free(state->worklist.item);
    free(state->key.item);
    state->worklist = p->entries;
    state->key = p->keys;
    p->entries = (struct par_worklist){0};
    p->keys = (struct par_keys){0};
}

static enum tri_status bad_fragment(struct tri_error *error)
{
    return tri_fail(error, TRI_INTERNAL, NULL, 0, "what came from another rank is no part of a mesh");
}

static bool are_below(const int32_t *item, int32_t n, int32_t end)
{
    bool good = true;
    for (int32_t i = 0; i < n; i++)
        good = good && item[i] >= 0 && item[i] < end;
    return good;
}

/* Is this a fragment for this mesh, whole, with nothing in it that names what is not there? */
static bool is_fragment(const struct par_state *state, const struct header *h, int32_t n_common, const char *bytes,
                        size_t n)
{
    if (n < sizeof *h || h->magic != MAGIC || h->bytes > n || h->n_common != n_common || h->n_named < 0 ||
        h->n_fresh < 0 || h->n_triangles < 0 || h->n_subs < 0 || h->n_entries < 0 || h->bytes < sizeof *h ||
        h->n_attributes != state->mesh->n_attributes)
        return false;
    const struct parts p = parts_of(h, (char *)bytes);
    if (p.bytes != h->bytes || h->hash != hash_of(bytes, h->bytes))
        return false;
    int32_t vertices = h->n_named + h->n_fresh;
    bool good = are_below(p.named, h->n_named, n_common) && are_below(p.entries, h->n_entries, h->n_triangles);
    for (int32_t i = 0; i < h->n_triangles; i++)
        good = good && are_below(p.triangles[i].v, 3, vertices);
    for (int32_t i = 0; i < h->n_subs; i++)
        good = good && are_below(p.subs[i].v, 2, vertices);
    return good;
}

static enum tri_status reserve_mesh(struct tri_mesh *mesh, const struct header *h, struct tri_error *error)
{
    enum tri_status status = tri_mesh_reserve_vertices(mesh, h->n_fresh, error);
    status = status ? status : tri_mesh_reserve_triangles(mesh, h->n_triangles, error);
    return status ? status : tri_mesh_reserve_subs(mesh, h->n_subs, error);
}

enum tri_status par_fragment_paste(struct par_state *state, int32_t n_common, const char *bytes, size_t n,
                                   size_t *used, struct tri_error *error)
{
    struct pasting p = {.state = state, .mesh = state->mesh, .header = (const struct header *)bytes};
    assert((uintptr_t)bytes % 8 == 0 && state->key.n == state->worklist.n);
    if (!is_fragment(state, p.header, n_common, bytes, n))
        return bad_fragment(error);
    p.parts = parts_of(p.header, (char *)bytes);
    par_room_mark(&state->spare, state->mesh);
    enum tri_status status = reserve_mesh(state->mesh, p.header, error);
    if (!status && !(inside_init(&p.inside, p.mesh, &p.header->box) && find_doomed(&p) && reserve_all(&p)))
        status = no_memory(error);
    if (!status)
        replace(&p);
    *used = p.header->bytes;
    struct par_worklist *lists[] = {&p.doomed_vertices, &p.doomed, &p.doomed_subs, &p.open_subs, &p.rim, &p.entries};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        free(lists[i]->item);
    free(p.keys.item);
    free(p.vertex);
    free(p.inside.word);
    table_free(&p.edges);
    table_free(&p.places);
    return status;
}
