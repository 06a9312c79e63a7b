#include "sched/schedule/halt.h"

#include <stdlib.h>

void par_halt_drop(struct par_halt *halt, struct par_room *spare)
{
    for (int32_t i = 0; i < halt->n_blocks; i++) {
        par_room_return(&halt->block[i].room, spare);
        free(halt->block[i].left.item);
        tri_pause_drop(&halt->block[i].pause);
    }
    free(halt->block);
    free(halt->worklist);
    *halt = (struct par_halt){0};
}
