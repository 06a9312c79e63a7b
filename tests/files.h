/* What tests look for in their folder. */
#ifndef TESTS_FILES_H
#define TESTS_FILES_H

#include <dirent.h>
#include <string.h>

/* Names in the current folder but . and ..; -1: it cannot be read. */
static inline int files_here(void)
{
    int n = 0;
    DIR *directory = opendir(".");
    if (!directory)
        return -1;
    for (const struct dirent *entry; (entry = readdir(directory));)
        n += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(directory);
    return n;
}

#endif
