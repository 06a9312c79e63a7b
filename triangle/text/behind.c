/* What cannot be asked for, or is done in part only, is written as everything else is. */
#include "triangle/text/behind.h"

#include <assert.h>
#include <errno.h>
#include <string.h>

static bool is_aligned(uint64_t place, const char *data, size_t size)
{
    return (place | (uint64_t)(uintptr_t)data | size) % TRI_BEHIND_BYTES == 0;
}

int tri_behind_start(struct tri_behind *behind, struct tri_output *output, uint64_t place, const char *data,
                     size_t size)
{
    assert(!behind->under_way && tri_output_has_places(output));
    if (tri_stop_is_asked(output->stop))
        return TRI_OUTPUT_STOPPED;
    memset(&behind->control, 0, sizeof behind->control);
    behind->control.aio_fildes = is_aligned(place, data, size) ? tri_output_direct(output) : output->file;
    behind->control.aio_offset = (off_t)place;
    behind->data = data;
    behind->control.aio_buf = (void *)data; /* is read alone */
    behind->control.aio_nbytes = size;
    behind->control.aio_sigevent.sigev_notify = SIGEV_NONE;
    behind->under_way = aio_write(&behind->control) == 0;
    return behind->under_way ? 0 : tri_output_write_at(output, place, data, size);
}

int tri_behind_wait(struct tri_behind *behind, const struct tri_output *output)
{
    const struct aiocb *const control = &behind->control;
    if (!behind->under_way)
        return 0;
    while (aio_error(control) == EINPROGRESS)
        (void)aio_suspend(&control, 1, NULL);
    const int fault = aio_error(control);
    const ssize_t written = aio_return(&behind->control);
    const size_t done = fault == 0 && written > 0 ? (size_t)written : 0;
    behind->under_way = false;
    return tri_output_write_at(output, (uint64_t)control->aio_offset + done, behind->data + done,
                               control->aio_nbytes - done);
}
