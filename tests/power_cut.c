/* A power cut for tests/test_sweep.sh, put under a program with LD_PRELOAD: it notes in the file POWER_CUT_LOG the number and
   length of every regular file that is brought down to the disk with fsync, and ends the program at the call of number
   POWER_CUT, as if it had not happened. What was not brought down before may be lost then. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

static int calls;

int fsync(int descriptor)
{
    struct stat file;
    int log, status;
    if (__sync_add_and_fetch(&calls, 1) == atoi(getenv("POWER_CUT")))
        _exit(137);
    status = (int)syscall(SYS_fsync, descriptor);
    if (status == 0 && fstat(descriptor, &file) == 0 && S_ISREG(file.st_mode)) {
        log = open(getenv("POWER_CUT_LOG"), O_WRONLY | O_CREAT | O_APPEND, 0666);
        dprintf(log, "%lu %lld\n", (unsigned long)file.st_ino, (long long)file.st_size);
        close(log);
    }
    return status;
}
