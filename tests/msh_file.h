/* A reader of binary .msh files, format 4.1, for tests. It is written from the format's description alone (Gmsh
 * reference manual, "MSH file format"). A malformed file fails the test. */
#ifndef TESTS_MSH_FILE_H
#define TESTS_MSH_FILE_H

#include <stdint.h>

enum { MSH_MOST_PARTS = 64 };

struct msh_entity {
    int32_t dimension, tag, physical; /* tag; 0: none */
    int32_t parent_dimension, parent; /* of a partitioned entity; tag 0: not partitioned */
    int64_t n_parts;
    int32_t part[MSH_MOST_PARTS];     /* [n_parts] */
};

struct msh_node {
    int64_t tag; /* number in the file */
    double at[3];
    const struct msh_entity *entity;
};

struct msh_element {
    int64_t tag, nodes[6]; /* node tags; entries from n_nodes on are 0 */
    int n_nodes;
    const struct msh_entity *entity;
};

struct msh_file {
    int64_t n_parts; /* number of parts of the mesh; 0: not partitioned */
    int n_entities;
    struct msh_entity *entity; /* [n_entities] */
    int64_t n_nodes, n_elements;
    struct msh_node *node;       /* [n_nodes] */
    struct msh_element *element; /* [n_elements] */
};

/* The caller frees the result. */
void msh_read(struct msh_file *msh, const char *path);
void msh_free(struct msh_file *msh);

#endif
