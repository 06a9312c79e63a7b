/* What -h prints, and what is printed where no input file is named. */
#ifndef DRIVERS_HELP_H
#define DRIVERS_HELP_H

void help_usage(const char *program);
void help_full(const char *program);

#endif
