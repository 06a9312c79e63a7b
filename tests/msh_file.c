#include "tests/msh_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST_BYTES = 1 << 20, MOST_ENTITIES = 1 << 12 };

struct bytes {
    const unsigned char *at, *end;
};

static uint64_t take_bits(struct bytes *b, int n)
{
    uint64_t bits = 0;
    assert_true(b->end - b->at >= n);
    for (int i = 0; i < n; i++)
        bits |= (uint64_t)*b->at++ << (8 * i); /* the files are little-endian */
    return bits;
}

static int64_t take_i64(struct bytes *b) { return (int64_t)take_bits(b, 8); }

static int32_t take_i32(struct bytes *b) { return (int32_t)take_bits(b, 4); }

static double take_f64(struct bytes *b)
{
    uint64_t bits = take_bits(b, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Finds the section between "$NAME
   " and "
   $EndNAME
   ". Returns false if it does not exist. */
static bool find_section(const struct bytes *all, const char *name, struct bytes *section)
{
    char begin[64], end[64];
    const int n = snprintf(begin, sizeof begin, "$%s\n", name), m = snprintf(end, sizeof end, "\n$End%s\n", name);
    const unsigned char *at = all->at;
    while (all->end - at >= n && memcmp(at, begin, (size_t)n) != 0)
        at++;
    if (all->end - at < n)
        return false;
    *section = (struct bytes){at + n, at + n};
    while (all->end - section->end >= m && memcmp(section->end, end, (size_t)m) != 0)
        section->end++;
    assert_true(all->end - section->end >= m);
    return true;
}

/* Skips the box, physical tags, and pieces of the boundary of an entity. */
static void take_shape(struct bytes *b, struct msh_entity *e)
{
    double box[6];
    for (int k = 0; k < 6; k++)
        box[k] = take_f64(b);
    assert_true(box[0] <= box[3] && box[1] <= box[4] && box[2] == 0 && box[5] == 0);
    const int64_t n = take_i64(b);
    assert_true(n == 0 || n == 1);
    e->physical = n > 0 ? take_i32(b) : 0;
    assert_int_equal(take_i64(b), 0);
}

static void take_parts(struct bytes *b, struct msh_entity *e)
{
    e->parent_dimension = take_i32(b);
    e->parent = take_i32(b);
    e->n_parts = take_i64(b);
    assert_true(e->n_parts >= 1 && e->n_parts <= MSH_MOST_PARTS);
    for (int64_t i = 0; i < e->n_parts; i++)
        e->part[i] = take_i32(b);
}

/* Curves and surfaces. */
static void take_entities(struct msh_file *msh, struct bytes *b, bool partitioned)
{
    int64_t n[4];
    for (int k = 0; k < 4; k++)
        n[k] = take_i64(b);
    assert_true(n[0] == 0 && n[3] == 0);
    for (int32_t dimension = 1; dimension <= 2; dimension++)
        for (int64_t i = 0; i < n[dimension]; i++) {
            assert_true(msh->n_entities < MOST_ENTITIES);
            struct msh_entity *e = &msh->entity[msh->n_entities++];
            *e = (struct msh_entity){.dimension = dimension, .tag = take_i32(b)};
            if (partitioned)
                take_parts(b, e);
            take_shape(b, e);
        }
    assert_true(b->at == b->end);
}

static const struct msh_entity *entity_of(const struct msh_file *msh, int32_t dimension, int32_t tag)
{
    const struct msh_entity *found = NULL;
    for (int i = 0; i < msh->n_entities; i++)
        if (msh->entity[i].dimension == dimension && msh->entity[i].tag == tag) {
            assert_null(found); /* each tag is used only once */
            found = &msh->entity[i];
        }
    assert_non_null(found);
    return found;
}

struct totals {
    int64_t blocks, n, least, greatest;
};

static struct totals take_totals(struct bytes *b)
{
    struct totals t = {take_i64(b), 0, 0, 0};
    t.n = take_i64(b);
    t.least = take_i64(b);
    t.greatest = take_i64(b);
    assert_true(t.n >= 0 && t.n <= MOST_BYTES);
    return t;
}

/* The header of the nodes or elements of an entity. */
struct block {
    const struct msh_entity *entity;
    int32_t kind; /* nodes: whether they have parameters; elements: their type */
    int64_t n;
};

static struct block take_block(const struct msh_file *msh, struct bytes *b)
{
    const int32_t dimension = take_i32(b), tag = take_i32(b), kind = take_i32(b);
    return (struct block){entity_of(msh, dimension, tag), kind, take_i64(b)};
}

static int64_t take_tag(struct bytes *b, const struct totals *t)
{
    const int64_t tag = take_i64(b);
    assert_true(tag >= t->least && tag <= t->greatest);
    return tag;
}

static void take_nodes(struct msh_file *msh, struct bytes *b)
{
    const struct totals t = take_totals(b);
    msh->node = calloc((size_t)t.n + 1, sizeof *msh->node);
    for (int64_t i = 0; i < t.blocks; i++) {
        const struct block block = take_block(msh, b);
        struct msh_node *node = msh->node + msh->n_nodes;
        assert_true(block.kind == 0 && msh->n_nodes + block.n <= t.n);
        for (int64_t k = 0; k < block.n; k++)
            node[k] = (struct msh_node){.tag = take_tag(b, &t), .entity = block.entity};
        for (int64_t k = 0; k < block.n; k++)
            for (int axis = 0; axis < 3; axis++)
                node[k].at[axis] = take_f64(b);
        msh->n_nodes += block.n;
    }
    assert_true(msh->n_nodes == t.n && b->at == b->end);
}

static int nodes_of_type(int32_t type)
{
    assert_true(type == 1 || type == 2 || type == 9);
    return type == 1 ? 2 : type == 2 ? 3 : 6;
}

static void take_elements(struct msh_file *msh, struct bytes *b)
{
    const struct totals t = take_totals(b);
    msh->element = calloc((size_t)t.n + 1, sizeof *msh->element);
    for (int64_t i = 0; i < t.blocks; i++) {
        const struct block block = take_block(msh, b);
        assert_true(block.n > 0 && msh->n_elements + block.n <= t.n);
        assert_int_equal(block.entity->dimension, block.kind == 1 ? 1 : 2);
        for (int64_t k = 0; k < block.n; k++) {
            struct msh_element *e = &msh->element[msh->n_elements++];
            *e = (struct msh_element){
                .tag = take_tag(b, &t), .n_nodes = nodes_of_type(block.kind), .entity = block.entity};
            for (int corner = 0; corner < e->n_nodes; corner++)
                e->nodes[corner] = take_i64(b);
        }
    }
    assert_true(msh->n_elements == t.n && b->at == b->end);
}

void msh_read(struct msh_file *msh, const char *path)
{
    FILE *file = fopen(path, "rb");
    unsigned char *data = malloc(MOST_BYTES);
    struct bytes section;
    *msh = (struct msh_file){.entity = calloc(MOST_ENTITIES, sizeof *msh->entity)};
    assert_true(file && data && msh->entity);
    const size_t size = fread(data, 1, MOST_BYTES, file);
    const struct bytes all = {data, data + size};
    fclose(file);
    assert_true(size < MOST_BYTES);
    assert_true(find_section(&all, "MeshFormat", &section));
    assert_int_equal(section.end - section.at, sizeof "4.1 1 8\n" - 1 + 4);
    assert_memory_equal(section.at, "4.1 1 8\n\1\0\0\0", sizeof "4.1 1 8\n" - 1 + 4);
    assert_true(find_section(&all, "Entities", &section));
    take_entities(msh, &section, false);
    if (find_section(&all, "PartitionedEntities", &section)) {
        msh->n_parts = take_i64(&section);
        assert_int_equal(take_i64(&section), 0); /* ghost elements */
        take_entities(msh, &section, true);
    }
    assert_true(find_section(&all, "Nodes", &section));
    take_nodes(msh, &section);
    assert_true(find_section(&all, "Elements", &section));
    take_elements(msh, &section);
    free(data);
}

void msh_free(struct msh_file *msh)
{
    free(msh->entity);
    free(msh->node);
    free(msh->element);
    *msh = (struct msh_file){0};
}
