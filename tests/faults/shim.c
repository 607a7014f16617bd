/* Loaded before the C library by scripts/faults.sh: the n-th call of one kind fails, does part of
   its work, or is met by a signal.

   NUVO_FAULT=KIND:N:WHAT   KIND: alloc open read write close fsync rename unlink, or any (any of
                            them but alloc). N: from 1; 0 only counts. WHAT: an errno's number;
                            part (half of a read's or write's bytes); zero (a read's end);
                            before-S or after-S (signal number S before or after the call).
   NUVO_FAULT_ONLY=TEXT     only files whose name holds TEXT are opened with a fault.
   NUVO_FAULT_COUNT=FILE    gets the number of calls of that kind, and whether the fault was met. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);

enum { kError, kPart, kZero, kBefore, kAfter };

static char kind[16];
static long wanted;
static int what, value;
static const char *only;
static atomic_long calls;

__attribute__((constructor)) static void begin(void) {
    const char *fault = getenv("NUVO_FAULT");
    char word[32] = "";
    only = getenv("NUVO_FAULT_ONLY");
    if (!fault || sscanf(fault, "%15[a-z]:%ld:%31s", kind, &wanted, word) < 2) return;
    if (strcmp(word, "part") == 0) what = kPart;
    else if (strcmp(word, "zero") == 0) what = kZero;
    else if (sscanf(word, "before-%d", &value) == 1) what = kBefore;
    else if (sscanf(word, "after-%d", &value) == 1) what = kAfter;
    else value = atoi(word);
}

__attribute__((destructor)) static void end(void) {
    const char *name = getenv("NUVO_FAULT_COUNT");
    char text[32];
    if (!name) return;
    kind[0] = '\0';
    const int file = (int)syscall(SYS_openat, AT_FDCWD, name, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int size = snprintf(text, sizeof text, "%ld\n", (long)calls);
    syscall(SYS_write, file, text, (size_t)size);
    syscall(SYS_close, file);
}

static int is_kind(const char *name) {
    return kind[0] && (strcmp(kind, name) == 0 || (strcmp(kind, "any") == 0 && strcmp(name, "alloc") != 0));
}

/* Nonzero where this call shall meet the fault. */
static int meets(const char *name) { return is_kind(name) && ++calls == wanted; }

static int fails(int met) {
    if (met && what == kBefore) syscall(SYS_kill, getpid(), value);
    if (met && what == kError) errno = value;
    return met && what == kError;
}

static void leave(int met) {
    if (met && what == kAfter) syscall(SYS_kill, getpid(), value);
}

void *malloc(size_t size) { return fails(meets("alloc")) ? NULL : __libc_malloc(size); }
void *calloc(size_t n, size_t size) { return fails(meets("alloc")) ? NULL : __libc_calloc(n, size); }
void *realloc(void *old, size_t size) {
    return fails(meets("alloc")) ? NULL : __libc_realloc(old, size);
}
void *memalign(size_t to, size_t size) {
    return fails(meets("alloc")) ? NULL : __libc_memalign(to, size);
}
void *aligned_alloc(size_t to, size_t size) { return memalign(to, size); }
int posix_memalign(void **result, size_t to, size_t size) {
    *result = memalign(to, size);
    return *result ? 0 : ENOMEM;
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static int open_at(const char *name, int flags, mode_t mode) {
    const int met = (!only || strstr(name, only)) && meets("open");
    if (fails(met)) return -1;
    const int result = (int)syscall(SYS_openat, AT_FDCWD, name, flags, mode);
    leave(met);
    return result;
}

int open(const char *name, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return open_at(name, flags, mode);
}
int open64(const char *name, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return open_at(name, flags, mode);
}
FILE *fopen64(const char *name, const char *mode) {
    const int met = (!only || strstr(name, only)) && meets("open");
    if (fails(met)) return NULL;
    FILE *file = NEXT(fopen64)(name, mode);
    leave(met);
    return file;
}
FILE *fopen(const char *name, const char *mode) { return fopen64(name, mode); }

static size_t part(int met, size_t size) { return met && what == kPart && size > 1 ? size / 2 : size; }

ssize_t read(int file, void *bytes, size_t size) {
    const int met = meets("read");
    if (fails(met)) return -1;
    if (met && what == kZero) return 0;
    const ssize_t result = syscall(SYS_read, file, bytes, part(met, size));
    leave(met);
    return result;
}
ssize_t write(int file, const void *bytes, size_t size) {
    const int met = meets("write");
    if (fails(met)) return -1;
    const ssize_t result = syscall(SYS_write, file, bytes, part(met, size));
    leave(met);
    return result;
}
ssize_t writev(int file, const struct iovec *parts, int count) {
    const int met = meets("write");
    if (fails(met)) return -1;
    const ssize_t result = syscall(SYS_writev, file, parts, met && what == kPart ? 1 : count);
    leave(met);
    return result;
}
int close(int file) {
    const int met = meets("close");
    const int failed = fails(met);
    const int error = errno;
    const int result = (int)syscall(SYS_close, file);
    leave(met);
    if (failed) errno = error;
    return failed ? -1 : result;
}
int fsync(int file) {
    const int met = meets("fsync");
    if (fails(met)) return -1;
    const int result = (int)syscall(SYS_fsync, file);
    leave(met);
    return result;
}
int rename(const char *from, const char *to) {
    const int met = meets("rename");
    if (fails(met)) return -1;
    const int result = (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
    leave(met);
    return result;
}
int unlink(const char *name) {
    const int met = meets("unlink");
    if (fails(met)) return -1;
    const int result = (int)syscall(SYS_unlinkat, AT_FDCWD, name, 0);
    leave(met);
    return result;
}
