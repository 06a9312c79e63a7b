/* Starts a program and interrupts or kills it a given time after it has written the first line to its output, a file.
 * Ends with the program's exit code. For tools/windows.sh.
 * Usage: poke c|kill MILLISECONDS COMMAND_LINE     c: as if Ctrl-C was pressed */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

/* The rest of the command line, after three words of this program. */
static char *command_of(char *line)
{
    for (int i = 0; i < 3; i++) {
        const char *end = *line == '"' ? strchr(line + 1, '"') : NULL;
        line = end ? line + (end + 1 - line) : line + strcspn(line, " ");
        line += strspn(line, " ");
    }
    return line;
}

static BOOL WINAPI ignore_ctrl_c(DWORD event) { return event == CTRL_C_EVENT; }

int main(int argc, char **argv)
{
    STARTUPINFOA start = {.cb = sizeof start, .dwFlags = STARTF_USESTDHANDLES}; /* a new console would receive it */
    PROCESS_INFORMATION made;
    DWORD code = 1;
    start.hStdInput = GetStdHandle(STD_INPUT_HANDLE);
    start.hStdOutput = GetStdHandle(STD_OUTPUT_HANDLE);
    start.hStdError = GetStdHandle(STD_ERROR_HANDLE);
    FreeConsole();
    if (argc < 4 || !AllocConsole() || !SetConsoleCtrlHandler(ignore_ctrl_c, TRUE) ||
        !CreateProcessA(NULL, command_of(GetCommandLineA()), NULL, NULL, TRUE, 0, NULL, NULL, &start, &made))
        return 3;
    while (GetFileSize(start.hStdOutput, NULL) == 0 && WaitForSingleObject(made.hProcess, 10) == WAIT_TIMEOUT) {
    }
    if (WaitForSingleObject(made.hProcess, (DWORD)atoi(argv[2])) == WAIT_TIMEOUT) {
        if (strcmp(argv[1], "kill") == 0)
            TerminateProcess(made.hProcess, 137);
        else if (!GenerateConsoleCtrlEvent(CTRL_C_EVENT, 0))
            fprintf(stderr, "poke: error %lu\n", GetLastError());
        if (WaitForSingleObject(made.hProcess, 60000) == WAIT_TIMEOUT)
            return 4;
    }
    GetExitCodeProcess(made.hProcess, &code);
    return (int)code;
}
