/* The definition behind the opaque struct tri_mesh of ptriangle/tri.h, and how such a mesh is made, independent of
 * the refinement used. */
#ifndef TRIANGLE_API_OPAQUE_MESH_H
#define TRIANGLE_API_OPAQUE_MESH_H

#include "ptriangle/tri.h"
#include "triangle/api/generate.h"

struct tri_api_mesh {
    struct tri_mesh mesh; /* must be first: callers point to it. No unused numbers, points in the caller's order */
    struct tri_report report;    /* of the stages that made the mesh */
    struct tri_settings refined; /* bounds of the last completed refinement; all 0 if there was none */
    bool has_triangles;   /* true: the figure was a mesh */
    bool has_areas;       /* true: the figure had size bounds */
    bool has_attributes;  /* true: the figure had attributes of triangles or regions */
    double *places;       /* [n_vertices][2] in the caller's coordinates; NULL: mesh.xy has these */
    double *attributes;   /* [n_triangles][number of region attributes]; NULL: none */
    int32_t *neighbors;   /* [n_triangles][3]; NULL until requested */
    int32_t *edges;       /* [n_edges][2]; NULL until requested */
    int32_t *edge_markers; /* [n_edges]; NULL until edges are requested */
    int32_t n_edges;       /* number of edges, if requested */
    char odd_length[160]; /* warning: edge_length returned an invalid length in the last refinement; "": no */
    char uncovered[256];  /* warning: a size field does not cover the mesh; "": no */
    char notes[sizeof(struct tri_notes) + 520]; /* warnings, one per line; "": none */
};

/* The refinement to use: tri_refine, or a parallel schedule. */
struct tri_api_way {
    enum tri_status (*refine)(const struct tri_api_way *way, struct tri_mesh *mesh,
                              const struct tri_quality *quality, const struct tri_refine_hooks *hooks,
                              const struct tri_settings *settings, struct tri_refine_report *report,
                              struct tri_error *error);
    const struct tri_executor *executor; /* runs parallel tasks; NULL: none */
    void *user;                          /* for `refine` */
    const struct tri_pslg *figure; /* for tri_api_mesh_stream: the input of the mesh; otherwise NULL */
    bool has_attributes;           /* for tri_api_mesh_stream: regions or triangles have attributes */
};

/* Copies and checks the caller's settings (NULL: defaults). Returns TRI_BAD_INPUT if a setting is invalid. */
enum tri_status tri_api_settings_take(struct tri_settings *settings, const struct tri_settings *given,
                                      struct tri_error *error);

/* The implementation of tri_mesh_new and tri_mesh_refine, for checked settings. */
enum tri_status tri_api_mesh_new(struct tri_mesh **mesh, const struct tri_figure *figure,
                                 const struct tri_settings *settings, const struct tri_api_way *way,
                                 struct tri_error *error);
enum tri_status tri_api_mesh_refine(struct tri_mesh *mesh, const struct tri_settings *settings,
                                    const struct tri_api_way *way, struct tri_error *error);

/* Makes a mesh that is streamed during refinement, for checked settings. way->refine is always called, even without
 * bounds, with way->figure and way->has_attributes set. The rest of the mesh is freed. */
enum tri_status tri_api_mesh_stream(const struct tri_figure *figure, const struct tri_settings *settings,
                                    const struct tri_api_way *way, struct tri_error *error);

#endif
