/*
 * Makes one call of a process fail: preloaded before the C library, it counts the calls that write below
 * a folder or to standard output, and gives one of them the requested result.
 *
 *   FAULT_ROOT    the folder
 *   FAULT_LOG     a file that gets a line for each call that is counted
 *   FAULT_AT      the number of the call that fails, from 1
 *   FAULT_RESULT  the error, as a number; 0 makes a write take half of its bytes
 *   FAULT_LASTS   if set, every later call fails, too
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum verdict { GOES_ON, FAILS, IS_SHORT };

static atomic_long count;

static int is_below(const char *path)
{
    const char *root = getenv("FAULT_ROOT");
    /* The process works in the folder. */
    return root && (path[0] != '/' || strncmp(path, root, strlen(root)) == 0);
}

static enum verdict judge(const char *call, const char *path)
{
    long number = atomic_fetch_add(&count, 1) + 1;
    const char *log = getenv("FAULT_LOG");
    const char *at = getenv("FAULT_AT");
    const char *result = getenv("FAULT_RESULT");
    if (log) {
        char line[PATH_MAX + 64];
        int length = snprintf(line, sizeof line, "%s %s\n", call, path);
        long file = syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_CREAT | O_APPEND, 0600);
        syscall(SYS_write, file, line, length);
        syscall(SYS_close, file);
    }
    if (!at || !result || !(number == atol(at) || (getenv("FAULT_LASTS") && number > atol(at))))
        return GOES_ON;
    if (atoi(result) == 0)
        return IS_SHORT;
    errno = atoi(result);
    return FAILS;
}

static enum verdict of_path(const char *call, const char *path)
{
    return path && is_below(path) ? judge(call, path) : GOES_ON;
}

static enum verdict of_file(const char *call, int file)
{
    char name[64], path[PATH_MAX];
    if (file == STDOUT_FILENO)
        return judge(call, "standard output");
    snprintf(name, sizeof name, "/proc/self/fd/%d", file);
    ssize_t length = readlink(name, path, sizeof path - 1);
    if (length <= 0)
        return GOES_ON;
    path[length] = 0;
    return path[0] == '/' ? of_path(call, path) : GOES_ON;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static int writes(int flags)
{
    return (flags & O_ACCMODE) != O_RDONLY || (flags & O_CREAT);
}

#define OPEN(name)                                                    \
    int name(const char *path, int flags, ...)                        \
    {                                                                 \
        va_list rest;                                                 \
        va_start(rest, flags);                                        \
        mode_t mode = va_arg(rest, mode_t);                           \
        va_end(rest);                                                 \
        if (writes(flags) && of_path("open", path) == FAILS)          \
            return -1;                                                \
        return REAL(name)(path, flags, mode);                         \
    }
OPEN(open)
OPEN(open64)

#define OPENAT(name)                                                  \
    int name(int folder, const char *path, int flags, ...)            \
    {                                                                 \
        va_list rest;                                                 \
        va_start(rest, flags);                                        \
        mode_t mode = va_arg(rest, mode_t);                           \
        va_end(rest);                                                 \
        if (writes(flags) && of_path("open", path) == FAILS)          \
            return -1;                                                \
        return REAL(name)(folder, path, flags, mode);                 \
    }
OPENAT(openat)
OPENAT(openat64)

ssize_t write(int file, const void *bytes, size_t length)
{
    enum verdict verdict = of_file("write", file);
    if (verdict == FAILS)
        return -1;
    if (verdict == IS_SHORT && length > 1)
        length /= 2;
    return syscall(SYS_write, file, bytes, length);
}

ssize_t writev(int file, const struct iovec *parts, int count)
{
    enum verdict verdict = of_file("write", file);
    if (verdict == FAILS)
        return -1;
    if (verdict == IS_SHORT && count > 0)
        return syscall(SYS_write, file, parts[0].iov_base, (parts[0].iov_len + 1) / 2);
    return REAL(writev)(file, parts, count);
}

/* The power stays on: nothing has to reach the disk, which takes long. */
int fsync(int file)
{
    return of_file("fsync", file) == FAILS ? -1 : 0;
}

int fdatasync(int file)
{
    return of_file("fdatasync", file) == FAILS ? -1 : 0;
}

/* A failing close closes all the same. */
int close(int file)
{
    enum verdict verdict = file > STDERR_FILENO ? of_file("close", file) : GOES_ON;
    int error = errno;
    int closed = syscall(SYS_close, file);
    if (verdict != FAILS)
        return closed;
    errno = error;
    return -1;
}

int fchmod(int file, mode_t mode)
{
    return of_file("fchmod", file) == FAILS ? -1 : REAL(fchmod)(file, mode);
}

int ftruncate64(int file, off64_t length)
{
    return of_file("ftruncate", file) == FAILS ? -1 : REAL(ftruncate64)(file, length);
}

int flock(int file, int how)
{
    return of_file("flock", file) == FAILS ? -1 : (int)syscall(SYS_flock, file, how);
}

int mkdir(const char *path, mode_t mode)
{
    return of_path("mkdir", path) == FAILS ? -1 : REAL(mkdir)(path, mode);
}

int rename(const char *from, const char *to)
{
    return of_path("rename", to) == FAILS ? -1 : REAL(rename)(from, to);
}

int renameat(int from_folder, const char *from, int to_folder, const char *to)
{
    return of_path("rename", to) == FAILS ? -1 : REAL(renameat)(from_folder, from, to_folder, to);
}

int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned int flags)
{
    if (of_path("rename", to) == FAILS)
        return -1;
    return syscall(SYS_renameat2, from_folder, from, to_folder, to, flags);
}

int linkat(int from_folder, const char *from, int to_folder, const char *to, int flags)
{
    if (of_path("link", to) == FAILS)
        return -1;
    return REAL(linkat)(from_folder, from, to_folder, to, flags);
}
