/* Each exchange begins with an agreement, so a rank that has failed is noticed at the next one. A rank that learns of
 * an error completes its current step. */
#include "drivers/mesh/joint_files.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/system.h"

static char spooled[] = ""; /* only positions, no names */

static bool is_first(const struct joint_files *j) { return j->carrier->rank == 0; }

static bool has(const struct joint_files *j, int i) { return j->ticket[i].path[0] != 0; }

/* Returns the output of this rank for file i. */
static struct tri_output *output_of(struct joint_files *j, int i)
{
    struct tri_output *const first[JOINT_TEXTS] = {j->text_options.node, j->text_options.ele, j->text_options.poly};
    if (!is_first(j))
        return &j->file[i];
    return i < JOINT_TEXTS ? first[i] : j->h5[i - JOINT_TEXTS].output;
}

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory to write files on several ranks");
}

/* --- opening */

/* Makes tickets for all existing files. Returns false if one has no ticket. */
static bool make_tickets(struct joint_files *j)
{
    bool made = true;
    for (int i = 0; i < JOINT_FILES; i++)
        if (output_of(j, i))
            made = tri_ticket_make(&j->ticket[i], output_of(j, i)) && made;
    return made;
}

static bool open_spool(const struct joint_files *j, struct tri_output *spool)
{
    *spool = (struct tri_output){.path = (char *)j->scratch, .temporary = spooled, .direct = TRI_NO_FILE,
                                  .stop = j->stop};
    spool->file = tri_scratch_file(j->scratch);
    return spool->file != TRI_NO_FILE;
}

static bool join_all(struct joint_files *j)
{
    bool joined = true;
    for (int i = 0; i < JOINT_FILES; i++)
        if (has(j, i))
            joined = tri_output_join(&j->file[i], &j->ticket[i], j->stop) && joined;
    for (int i = 0; i < JOINT_TEXTS; i++)
        if (has(j, i))
            joined = open_spool(j, &j->spool[i]) && joined;
    return joined;
}

/* Makes all tickets invalid. */
static enum tri_status begin_files_again(struct joint_files *j, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int i = 0; i < JOINT_FILES && !status; i++)
        if (has(j, i))
            status = tri_output_restart(output_of(j, i), error);
    return status;
}

/* Returns true if it is true on all ranks. */
static enum tri_status ask_all(struct joint_files *j, bool yes, bool *all, enum tri_status status,
                               struct tri_error *error)
{
    const int64_t mine = yes;
    int64_t sum = 0;
    status = par_sum(j->carrier, &mine, 1, &sum, status, error);
    *all = !status && sum == j->carrier->n_ranks;
    return status;
}

enum tri_status joint_files_open(struct joint_files *joint, bool wanted, enum tri_status status,
                                 struct tri_error *error)
{
    bool ready = true;
    for (int i = 0; i < JOINT_FILES; i++)
        joint->file[i].file = TRI_NO_FILE;
    for (int i = 0; i < JOINT_TEXTS; i++)
        joint->spool[i].file = TRI_NO_FILE;
    joint->ticket = calloc(JOINT_FILES, sizeof *joint->ticket);
    if (!status && !joint->ticket)
        status = no_memory(error);
    if (!status && is_first(joint))
        ready = make_tickets(joint) && wanted;
    status = par_spread(joint->carrier, PAR_MOVE_TILES, joint->ticket, JOINT_FILES * sizeof *joint->ticket, status,
                        error);
    if (!status && !is_first(joint))
        ready = join_all(joint);
    status = ask_all(joint, ready, &joint->together, status, error);
    if (!status && is_first(joint))
        status = begin_files_again(joint, error);
    return par_agree(joint->carrier, status, error);
}

/* --- beginning */

static enum tri_status begin_spools(struct joint_files *j, const struct tri_stream *stream, struct tri_error *error)
{
    struct tri_text_options options = j->text_options;
    struct tri_output **const outputs[JOINT_TEXTS] = {&options.node, &options.ele, &options.poly};
    for (int i = 0; i < JOINT_TEXTS; i++)
        *outputs[i] = has(j, i) ? &j->spool[i] : NULL;
    enum tri_status status = tri_text_stream_new(&j->stream, &options, &j->to_spool, error);
    return status ? status : j->to_spool.begin(j->to_spool.user, stream, error);
}

static enum tri_status begin_first(struct joint_files *j, const struct tri_stream *stream, struct tri_error *error)
{
    enum tri_status status = j->text.begin ? j->text.begin(j->text.user, stream, error) : TRI_OK;
    for (int i = 0; i < JOINT_H5 && !status; i++) {
        struct joint_h5 *h = &j->h5[i];
        if (h->writer)
            status = h->sink.begin(h->sink.user, stream, error);
        if (h->writer && !status)
            h->layout = *tri_h5_writer_layout(h->writer);
    }
    return status;
}

/* Shares the places of the rows of an HDF5 file. Collective. */
static enum tri_status share_layout(struct joint_files *j, int i, const struct tri_stream *stream,
                                    enum tri_status status, struct tri_error *error)
{
    struct joint_h5 *h = &j->h5[i];
    status = par_spread(j->carrier, PAR_MOVE_TILES, &h->layout, sizeof h->layout, status, error);
    for (int kind = 0; kind < TRI_H5_KINDS; kind++) {
        struct tri_h5_plan *laid = &h->layout.array[kind];
        const size_t bytes = (size_t)laid->n * sizeof *laid->place;
        if (!is_first(j)) /* received from the first rank */
            laid->place = status ? NULL : malloc(bytes + 1);
        status = !status && !laid->place && bytes > 0 ? no_memory(error) : status;
        status = par_spread(j->carrier, PAR_MOVE_TILES, laid->place, bytes, status, error);
    }
    if (status)
        return status;
    return tri_h5_part_new(&h->part, &h->layout, false, stream, output_of(j, JOINT_TEXTS + i), error);
}

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct joint_files *j = user;
    assert(j->together && stream->n_ranks == j->carrier->n_ranks && stream->rank == j->carrier->rank);
    j->total[0] = stream->first_vertex[stream->n_ranks];
    j->total[1] = stream->first_triangle[stream->n_ranks];
    j->total[2] = stream->first_segment[stream->n_ranks];
    j->n_attributes = stream->n_attributes;
    j->bounds[0] = j->bounds[1] = HUGE_VAL;
    j->bounds[2] = j->bounds[3] = -HUGE_VAL;
    enum tri_status status = is_first(j) ? begin_first(j, stream, error) : begin_spools(j, stream, error);
    for (int i = 0; i < JOINT_H5; i++)
        if (has(j, JOINT_TEXTS + i))
            status = share_layout(j, i, stream, status, error);
    return status;
}

/* --- tiles */

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct joint_files *j = user;
    const struct tri_sink *text = is_first(j) ? &j->text : &j->to_spool;
    enum tri_status status = text->take ? text->take(text->user, tile, error) : TRI_OK;
    struct tri_tile used;
    void *room;
    if (!status && !orphans_leave_out(&j->orphans, tile, j->n_attributes, &used, &room))
        status = no_memory(error);
    if (status)
        return status;
    for (int i = 0; i < JOINT_H5 && !status; i++)
        if (j->h5[i].part)
            status = tri_h5_part_take(j->h5[i].part, &used, error);
    tri_h5_extend_bounds(j->bounds, &used);
    j->n_input += used.column < 0 ? used.n_vertices : 0;
    free(room);
    return status;
}

/* --- ending */

/* Copies the own lines of text i to their place, which follows from the number of bytes of each rank. */
static enum tri_status put_lines(struct joint_files *j, int i, const int64_t *bytes, struct tri_error *error)
{
    uint64_t before = 0, all = 0;
    for (int p = 0; p < j->carrier->n_ranks; p++) {
        before += p < j->carrier->rank ? (uint64_t)bytes[p * JOINT_TEXTS + i] : 0;
        all += (uint64_t)bytes[p * JOINT_TEXTS + i];
    }
    if (!is_first(j))
        return tri_output_copy(&j->spool[i], &j->file[i], before, j->spool[i].size, error);
    (void)tri_output_reserve(output_of(j, i), (size_t)(all - output_of(j, i)->size));
    return TRI_OK;
}

/* Copies all texts to their places. Collective. */
static enum tri_status put_texts(struct joint_files *j, enum tri_status status, struct tri_error *error)
{
    int64_t mine[JOINT_TEXTS], *bytes = malloc((size_t)j->carrier->n_ranks * sizeof mine);
    for (int i = 0; i < JOINT_TEXTS; i++)
        mine[i] = !has(j, i) ? 0 : (int64_t)(is_first(j) ? output_of(j, i)->size : j->spool[i].size);
    if (!status && !bytes)
        status = no_memory(error);
    status = par_gather(j->carrier, mine, JOINT_TEXTS, bytes, status, error);
    for (int i = 0; i < JOINT_TEXTS && !status; i++)
        status = has(j, i) ? put_lines(j, i, bytes, error) : TRI_OK;
    free(bytes);
    return status;
}

/* Writes the data to the disk before files get their names: each machine flushes its own rows. */
static enum tri_status leave_all(struct joint_files *j, struct tri_error *error)
{
    enum { MOST_BYTES = 128 }; /* bytes of a triangle with its share of vertices, without attributes */
    const bool on_disk = !j->no_sync && j->total[1] >= TRI_SYNC_BYTES / MOST_BYTES;
    enum tri_status status = TRI_OK;
    for (int i = 0; i < JOINT_FILES && !status; i++)
        status = tri_output_leave(&j->file[i], on_disk, error);
    return status;
}

/* Finds the bounds of all points. Collective; afterwards all rows have been written. */
static enum tri_status gather_bounds(struct joint_files *j, double bounds[4], enum tri_status status,
                                     struct tri_error *error)
{
    int64_t mine[4], *all = malloc((size_t)j->carrier->n_ranks * sizeof mine);
    memcpy(mine, j->bounds, sizeof mine);
    memcpy(bounds, j->bounds, sizeof mine);
    if (!status && !all)
        status = no_memory(error);
    status = par_gather(j->carrier, mine, 4, all, status, error);
    for (int p = 0; p < j->carrier->n_ranks && !status; p++) {
        double of[4];
        memcpy(of, all + (size_t)p * 4, sizeof of);
        for (int k = 0; k < 4; k++)
            if (k < 2 ? of[k] < bounds[k] : of[k] > bounds[k])
                bounds[k] = of[k];
    }
    free(all);
    return status;
}

static enum tri_status end_first(struct joint_files *j, const double bounds[4], struct tri_error *error)
{
    enum tri_status status = j->text.end ? j->text.end(j->text.user, error) : TRI_OK;
    for (int i = 0; i < JOINT_H5 && !status; i++)
        if (j->h5[i].writer) {
            tri_h5_writer_set_totals(j->h5[i].writer, j->n_input, bounds);
            status = j->h5[i].sink.end(j->h5[i].sink.user, error);
        }
    return status;
}

static enum tri_status end(void *user, struct tri_error *error)
{
    struct joint_files *j = user;
    double bounds[4];
    enum tri_status status = TRI_OK;
    for (int i = 0; i < JOINT_H5 && !status; i++)
        if (j->h5[i].part)
            status = tri_h5_part_end(j->h5[i].part, error);
    status = put_texts(j, status, error);
    status = status ? status : leave_all(j, error);
    status = gather_bounds(j, bounds, status, error);
    return status || !is_first(j) ? status : end_first(j, bounds, error);
}

struct tri_sink joint_files_sink(struct joint_files *joint) { return (struct tri_sink){joint, begin, take, end}; }

/* --- closing */

enum tri_status joint_files_close(struct joint_files *joint, enum tri_status status, struct tri_error *error)
{
    for (int i = 0; i < JOINT_FILES; i++)
        (void)tri_output_leave(&joint->file[i], false, NULL);
    for (int i = 0; i < JOINT_TEXTS; i++)
        (void)tri_output_leave(&joint->spool[i], false, NULL);
    for (int i = 0; i < JOINT_H5; i++) {
        tri_h5_part_free(joint->h5[i].part);
        for (int kind = 0; kind < TRI_H5_KINDS && !is_first(joint); kind++)
            free(joint->h5[i].layout.array[kind].place);
    }
    tri_text_stream_free(joint->stream);
    free(joint->ticket);
    joint->ticket = NULL;
    return par_agree(joint->carrier, status, error);
}
