/* triangle: the mesh generator on one core, with the command line, the files and the printed lines of Triangle. */
#include "drivers/run.h"

int main(int argc, char **argv)
{
    const struct run_hooks hooks = {.program = "triangle"};
    return run_words(argc, argv, &hooks);
}
