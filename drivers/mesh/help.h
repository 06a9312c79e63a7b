/* What -h prints, and what is printed where no input file is named. */
#ifndef DRIVERS_MESH_HELP_H
#define DRIVERS_MESH_HELP_H

void help_usage(const char *program);
/* where it works: "on one core"; further: a paragraph about more options, or NULL. */
void help_full(const char *program, const char *where, const char *further);

#endif
