/* What POSIX (2008), and flock, give by macros, structures and calls with a varying number of arguments, whose values and layouts
   differ between systems, for posix_files, posix_processes and posix_signals; they bind the plain calls themselves. */
#define _XOPEN_SOURCE 700
#define _DARWIN_C_SOURCE   /* flock, which is older than POSIX, on macOS */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* The number of the error of the last call, and its text. */
int system_error(void) { return errno; }

void system_error_text(int number, char *text, size_t size) {
  if (strerror_r(number, text, size)) strncpy(text, "unknown error", size);
}

/* Files. `way` is an index of `ways`; see posix_files. */
int system_open(const char *path, int way) {
  static const int ways[] = {O_RDONLY, O_RDONLY | O_NONBLOCK, O_WRONLY | O_APPEND | O_NONBLOCK, O_RDWR | O_CREAT | O_EXCL, O_RDWR};
  return open(path, ways[way] | O_CLOEXEC, 0666);
}

/* 1 a regular file, 2 a folder, 3 something else, 0 nothing: the open file, or if that is negative what the path leads to. */
int system_kind(int file, const char *path) {
  struct stat it;
  if (file < 0 ? stat(path, &it) : fstat(file, &it)) return 0;
  return S_ISREG(it.st_mode) ? 1 : S_ISDIR(it.st_mode) ? 2 : 3;
}

/* Whether the path is the name of this open file itself; 2 if it is a link. */
int system_is_name(const char *path, int file) {
  struct stat named, opened;
  if (lstat(path, &named) || fstat(file, &opened)) return 0;
  return S_ISLNK(named.st_mode) ? 2 : named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
}

/* Lock an open file against others until it is closed: 1 if it is locked. Locks of POSIX would not keep out a second run of the same
   process, and would end when any of its files of that name is closed. */
int system_lock(int file) { return flock(file, LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK; }

/* Wait until the content of a file is on its disk, if the file system offers that. */
int system_synchronise(int file) {
  int failed = fsync(file);
  return failed && errno != EINVAL && errno != ENOSYS && errno != ENOTSUP && errno != EOPNOTSUPP ? failed : 0;
}

/* The next name in a folder that opendir has opened. */
const char *system_next_name(void *folder) {
  struct dirent *entry = readdir(folder);
  return entry ? entry->d_name : NULL;
}

/* Whether a file has something to read, or has ended, within this time. */
int system_has_input(int file, int milliseconds) {
  struct pollfd it = {.fd = file, .events = POLLIN};
  return poll(&it, 1, milliseconds) > 0;
}

/* Processes: a copy ends when `interrupted` is asked and the process that it is a copy of has ended. */
static pid_t copied;

int system_fork(void) {
  pid_t own = getpid(), made = fork();
  if (made == 0) copied = own;
  return made;
}

/* Wait for a copy: the signal that has ended it, or 0. */
int system_wait(int process) {
  int status;
  while (waitpid(process, &status, 0) != process && errno == EINTR) continue;
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

void system_ask_to_end(int process) { kill(process, SIGTERM); }

/* Signals. */
static const int held[] = {SIGHUP, SIGINT, SIGUSR1, SIGUSR2, SIGTERM, SIGXCPU};
enum { n_held = sizeof held / sizeof *held };

void system_hold_signals(sigset_t *before) {
  sigset_t set;
  struct sigaction now;
  sigemptyset(&set);
  for (int i = 0; i < n_held; i++)
    if (sigaction(held[i], NULL, &now) || now.sa_handler != SIG_IGN) sigaddset(&set, held[i]);
  pthread_sigmask(SIG_BLOCK, &set, before);
}

void system_restore_signals(const sigset_t *before) { pthread_sigmask(SIG_SETMASK, before, NULL); }

int system_interrupted(void) {
  sigset_t pending;
  if (copied && getppid() != copied) _exit(1);
  if (sigpending(&pending)) return 0;
  for (int i = 0; i < n_held; i++)
    if (sigismember(&pending, held[i]) == 1) return 1;
  return 0;
}

void system_ignore_write_signals(void) {
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
}
