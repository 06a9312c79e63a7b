#include "sched/halt.h"

#include <stdlib.h>

void par_halted_drop_pause(struct par_halted *halted)
{
    if (halted->pause)
        tri_pause_free(halted->pause);
    free(halted->pause);
    halted->pause = NULL;
}

void par_halt_drop(struct par_halt *halt, struct par_room *spare)
{
    for (int32_t i = 0; i < halt->n_blocks; i++) {
        par_room_return(&halt->block[i].room, spare);
        free(halt->block[i].left.item);
        par_halted_drop_pause(&halt->block[i]);
    }
    free(halt->block);
    free(halt->worklist);
    *halt = (struct par_halt){0};
}
