/* What lies behind the opaque struct tri_mesh of ptriangle/tri.h, and how a mesh comes to be, whoever refines it. */
#ifndef TRIANGLE_API_OPAQUE_MESH_H
#define TRIANGLE_API_OPAQUE_MESH_H

#include "ptriangle/tri.h"
#include "triangle/api/generate.h"

struct tri_api_mesh {
    struct tri_mesh mesh; /* first: what callers point to. No free numbers, points in the order of the caller */
    struct tri_report report;
    struct tri_settings refined; /* bounds of the last refinement, if it ended; all 0 if none has */
    bool has_triangles;   /* the figure was a mesh .. */
    bool has_areas;       /* .. bounds of sizes came with it .. */
    bool has_attributes;  /* .. and attributes of triangles or regions did */
    double *places;       /* [n_vertices][2] in the caller's coordinates; NULL: they are mesh.xy */
    double *attributes;   /* [n_triangles][as many as tri_region_attributes has]; NULL where there are none */
    int32_t *neighbors;   /* [n_triangles][3] NULL until they are asked for .. */
    int32_t *edges;       /* [n_edges][2] .. these too .. */
    int32_t *edge_markers; /* [n_edges] .. with their markers */
    int32_t n_edges;
    char odd_length[160]; /* that the last refinement's edge_length returned what is no length; "": it did not */
    char uncovered[256];  /* that a field of its sizes does not cover the mesh; "": they do */
    char notes[sizeof(struct tri_notes) + 520];
};

/* Who refines: tri_refine, or a schedule. */
struct tri_api_way {
    enum tri_status (*refine)(const struct tri_api_way *way, struct tri_mesh *mesh,
                              const struct tri_quality *quality, const struct tri_refine_hooks *hooks,
                              const struct tri_settings *settings, struct tri_refine_report *report,
                              struct tri_error *error);
    const struct tri_executor *executor;
    void *user;
    const struct tri_pslg *figure; /* for tri_api_mesh_stream: the mesh's input .. */
    bool has_attributes;           /* .. and whether regions or triangles have any there */
};

/* The caller's settings (NULL: none) as this library knows them. TRI_BAD_INPUT: one has no meaning. */
enum tri_status tri_api_settings_take(struct tri_settings *settings, const struct tri_settings *given,
                                      struct tri_error *error);

/* tri_mesh_new and tri_mesh_refine; settings have been taken. */
enum tri_status tri_api_mesh_new(struct tri_mesh **mesh, const struct tri_figure *figure,
                                 const struct tri_settings *settings, const struct tri_api_way *way,
                                 struct tri_error *error);
enum tri_status tri_api_mesh_refine(struct tri_mesh *mesh, const struct tri_settings *settings,
                                    const struct tri_api_way *way, struct tri_error *error);

/* For a mesh that is handed out while it is refined: refine is called whatever the bounds, with way->figure and
 * way->has_attributes set, and what it leaves is freed. Settings have been taken. */
enum tri_status tri_api_mesh_stream(const struct tri_figure *figure, const struct tri_settings *settings,
                                    const struct tri_api_way *way, struct tri_error *error);

#endif
