/* Starts a program with its own console and process group, and sends it an event of this console, as Windows does.
   For tests only.

   console_event EVENT PROGRAM ARGUMENT...

   The number EVENT is a CTRL_..._EVENT, or KILL. The event is sent when stdin ends. Prints how long the program took to
   end, and ends with its exit code. */
#include <stdio.h>
#include <stdlib.h>
#include <windows.h>

enum { KILL = 99 };

static int fail(const char *what)
{
    fprintf(stderr, "console_event: %s: error %lu\n", what, GetLastError());
    return 100;
}

/* GenerateConsoleCtrlEvent has two of the events only, and fails in Wine 8. Windows itself starts a thread with this
   routine in the program for each event. */
static BOOL deliver(DWORD event, HANDLE program)
{
    FARPROC routine = GetProcAddress(GetModuleHandleA("kernelbase.dll"), "CtrlRoutine");

    if (event == KILL)
        return TerminateProcess(program, KILL);
    return CreateRemoteThread(program, NULL, 0, (LPTHREAD_START_ROUTINE)routine, (void *)(size_t)event, 0, NULL) != NULL;
}

int main(int argc, char **argv)
{
    static char words[32768];
    SECURITY_ATTRIBUTES inherited = {sizeof(inherited), NULL, TRUE};
    STARTUPINFOA start = {.cb = sizeof(start), .dwFlags = STARTF_USESTDHANDLES};
    PROCESS_INFORMATION program;
    DWORD event = strtoul(argv[1], NULL, 10), code;
    ULONGLONG moment;
    int i;

    for (i = 2; i < argc; i++)
        snprintf(words + strlen(words), sizeof(words) - strlen(words), "\"%s\" ", argv[i]);
    start.hStdInput = CreateFileA("NUL", GENERIC_READ, FILE_SHARE_READ, &inherited, OPEN_EXISTING, 0, NULL);
    start.hStdOutput = GetStdHandle(STD_OUTPUT_HANDLE);
    start.hStdError = GetStdHandle(STD_ERROR_HANDLE);
    if (!CreateProcessA(NULL, words, NULL, NULL, TRUE, CREATE_NO_WINDOW, NULL, NULL, &start,
                        &program))
        return fail(words);
    while (getchar() != EOF) { }
    moment = GetTickCount64();
    if (!deliver(event, program.hProcess))
        return fail("the event");
    WaitForSingleObject(program.hProcess, INFINITE);
    fprintf(stderr, "console_event: ended after %llu ms\n", GetTickCount64() - moment);
    GetExitCodeProcess(program.hProcess, &code);
    return code;
}
