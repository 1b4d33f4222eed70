/* A disk that is full from a given write on, for one folder and the processes that are told of it.

   Loaded with LD_PRELOAD it counts whatever needs room under the folder FULL_DISK_ROOT: bytes written, files and
   folders made, names changed, sizes set, and fsync, where some file systems first say that there is none left. It
   thereby reaches what Python cannot: SQLite, and Chroma, which is Rust with a SQLite of its own.

   FULL_DISK_STATE is a file of four 64-bit integers, shared by all processes and by whoever steers them:
   0 how many writes there were, 1 the number of the first that fails (counted from 1; 0: none does),
   2 what then happens (0: this one fails and no other; 1: this one writes half, and from then on all fail),
   3 how many failed.
   After them come the writes' names, of 64 bytes each: the call, and the end of the path. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum { NAMES = 16384, NAME = 64 };
static volatile int64_t *state;
static __thread char last[PATH_MAX];
static char root[PATH_MAX];
static size_t length;

__attribute__((constructor)) static void begin(void) {
  const char *where = getenv("FULL_DISK_STATE"), *under = getenv("FULL_DISK_ROOT");
  if (!where || !under) return;
  int fd = open(where, O_RDWR | O_CLOEXEC);
  if (fd < 0) return;
  void *at = mmap(NULL, 4 * sizeof(int64_t) + NAMES * NAME, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  close(fd);
  if (at == MAP_FAILED) return;
  snprintf(root, sizeof root, "%s", under);
  length = strlen(root);
  state = at;
}

static int inside(const char *path) {
  if (strncmp(path, root, length) || (path[length] != '/' && path[length])) return 0;
  snprintf(last, sizeof last, "%s", path + length);
  return 1;
}

static int named(int folder, const char *path) {
  char whole[2 * PATH_MAX], base[PATH_MAX], link[64];
  if (!state) return 0;
  if (path[0] == '/') return inside(path);
  ssize_t n;
  if (folder == AT_FDCWD) {
    if (!getcwd(base, sizeof base)) return 0;
  } else {
    snprintf(link, sizeof link, "/proc/self/fd/%d", folder);
    if ((n = readlink(link, base, sizeof base - 1)) < 0) return 0;
    base[n] = 0;
  }
  snprintf(whole, sizeof whole, "%s/%s", base, path);
  return inside(whole);
}

static int opened(int fd) {
  char link[64], path[PATH_MAX];
  if (!state) return 0;
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  ssize_t n = readlink(link, path, sizeof path - 1);
  if (n < 0) return 0;
  path[n] = 0;
  return inside(path);
}

/* 0: there is room. 1: there is none. 2: there is room for half. */
static int refused(const char *call) {
  int64_t number = __sync_add_and_fetch(&state[0], 1), from = state[1];
  size_t n = strlen(last), most = NAME - 2 - strlen(call);
  if (number <= NAMES)
    snprintf((char *)(state + 4) + (number - 1) * NAME, NAME, "%s %s", call, last + (n > most ? n - most : 0));
  if (!from || number < from || (number > from && !state[2])) return 0;
  __sync_add_and_fetch(&state[3], 1);
  errno = ENOSPC;
  return number == from && state[2] ? 2 : 1;
}

#define REAL(kind, name, ...) \
  static kind (*real)(__VA_ARGS__); \
  if (!real) real = (kind(*)(__VA_ARGS__))dlsym(RTLD_NEXT, #name)

#define WRITES(name, more, given, size, half) \
  ssize_t name more { \
    REAL(ssize_t, name, SIGNATURE_##name); \
    int no = opened(fd) ? refused(#name) : 0; \
    if (no == 2 && (size) > 1) return half; \
    return no ? (errno = ENOSPC, -1) : real given; \
  }

#define SIGNATURE_write int, const void *, size_t
#define SIGNATURE_pwrite int, const void *, size_t, off_t
#define SIGNATURE_pwrite64 int, const void *, size_t, off64_t
WRITES(write, (int fd, const void *data, size_t n), (fd, data, n), n, real(fd, data, n / 2))
WRITES(pwrite, (int fd, const void *data, size_t n, off_t at), (fd, data, n, at), n, real(fd, data, n / 2, at))
WRITES(pwrite64, (int fd, const void *data, size_t n, off64_t at), (fd, data, n, at), n, real(fd, data, n / 2, at))

#define ON_FILE(kind, name, more, given, ...) \
  kind name more { \
    REAL(kind, name, __VA_ARGS__); \
    return opened(fd) && refused(#name) ? (errno = ENOSPC, -1) : real given; \
  }

ON_FILE(ssize_t, writev, (int fd, const struct iovec *v, int n), (fd, v, n), int, const struct iovec *, int)
ON_FILE(ssize_t, pwritev, (int fd, const struct iovec *v, int n, off_t at), (fd, v, n, at), int, const struct iovec *, int, off_t)
ON_FILE(ssize_t, pwritev64, (int fd, const struct iovec *v, int n, off64_t at), (fd, v, n, at), int, const struct iovec *, int, off64_t)
ON_FILE(int, ftruncate, (int fd, off_t n), (fd, n), int, off_t)
ON_FILE(int, ftruncate64, (int fd, off64_t n), (fd, n), int, off64_t)
ON_FILE(int, fallocate, (int fd, int mode, off_t at, off_t n), (fd, mode, at, n), int, int, off_t, off_t)
ON_FILE(int, fallocate64, (int fd, int mode, off64_t at, off64_t n), (fd, mode, at, n), int, int, off64_t, off64_t)
ON_FILE(int, fsync, (int fd), (fd), int)
ON_FILE(int, fdatasync, (int fd), (fd), int)
ON_FILE(ssize_t, copy_file_range, (int in, off64_t *from, int fd, off64_t *to, size_t n, unsigned flags),
        (in, from, fd, to, n, flags), int, off64_t *, int, off64_t *, size_t, unsigned)
ON_FILE(ssize_t, sendfile, (int fd, int in, off_t *from, size_t n), (fd, in, from, n), int, int, off_t *, size_t)
ON_FILE(ssize_t, sendfile64, (int fd, int in, off64_t *from, size_t n), (fd, in, from, n), int, int, off64_t *, size_t)

#define FALLOCATES(name, type) \
  int name(int fd, type at, type n) { \
    REAL(int, name, int, type, type); \
    return opened(fd) && refused(#name) ? ENOSPC : real(fd, at, n); \
  }
FALLOCATES(posix_fallocate, off_t)
FALLOCATES(posix_fallocate64, off64_t)

#define ON_NAME(name, folder, path, more, given, ...) \
  int name more { \
    REAL(int, name, __VA_ARGS__); \
    return named(folder, path) && refused(#name) ? (errno = ENOSPC, -1) : real given; \
  }

ON_NAME(rename, AT_FDCWD, to, (const char *from, const char *to), (from, to), const char *, const char *)
ON_NAME(renameat, dir, to, (int at, const char *from, int dir, const char *to), (at, from, dir, to), int, const char *, int, const char *)
ON_NAME(renameat2, dir, to, (int at, const char *from, int dir, const char *to, unsigned flags), (at, from, dir, to, flags), int, const char *, int, const char *, unsigned)
ON_NAME(link, AT_FDCWD, to, (const char *from, const char *to), (from, to), const char *, const char *)
ON_NAME(symlink, AT_FDCWD, to, (const char *from, const char *to), (from, to), const char *, const char *)

/* What is there already takes no room. */
static int makes(const char *call, int folder, const char *path, int flags) {
  return (flags & O_CREAT) && named(folder, path) && faccessat(folder, path, F_OK, 0) && refused(call);
}

int mkdir(const char *path, mode_t mode) {
  REAL(int, mkdir, const char *, mode_t);
  return makes("mkdir", AT_FDCWD, path, O_CREAT) ? (errno = ENOSPC, -1) : real(path, mode);
}

int mkdirat(int dir, const char *path, mode_t mode) {
  REAL(int, mkdirat, int, const char *, mode_t);
  return makes("mkdirat", dir, path, O_CREAT) ? (errno = ENOSPC, -1) : real(dir, path, mode);
}

#define OPENS(name) \
  int name(const char *path, int flags, ...) { \
    va_list rest; \
    va_start(rest, flags); \
    mode_t mode = (flags & (O_CREAT | O_TMPFILE)) ? va_arg(rest, mode_t) : 0; \
    va_end(rest); \
    REAL(int, name, const char *, int, ...); \
    return makes(#name, AT_FDCWD, path, flags) ? (errno = ENOSPC, -1) : real(path, flags, mode); \
  }
#define OPENS_AT(name) \
  int name(int dir, const char *path, int flags, ...) { \
    va_list rest; \
    va_start(rest, flags); \
    mode_t mode = (flags & (O_CREAT | O_TMPFILE)) ? va_arg(rest, mode_t) : 0; \
    va_end(rest); \
    REAL(int, name, int, const char *, int, ...); \
    return makes(#name, dir, path, flags) ? (errno = ENOSPC, -1) : real(dir, path, flags, mode); \
  }
OPENS(open)
OPENS(open64)
OPENS_AT(openat)
OPENS_AT(openat64)

#define FOPENS(name) \
  FILE *name(const char *path, const char *mode) { \
    REAL(FILE *, name, const char *, const char *); \
    int flags = mode[0] == 'r' ? 0 : O_CREAT; \
    return makes(#name, AT_FDCWD, path, flags) ? (errno = ENOSPC, NULL) : real(path, mode); \
  }
FOPENS(fopen)
FOPENS(fopen64)

/* What C's own streams write reaches the system from within the C library, where nobody else can step in. */
size_t fwrite(const void *data, size_t size, size_t n, FILE *file) {
  REAL(size_t, fwrite, const void *, size_t, size_t, FILE *);
  return state && opened(fileno(file)) && refused("fwrite") ? (errno = ENOSPC, 0) : real(data, size, n, file);
}

int fclose(FILE *file) {
  REAL(int, fclose, FILE *);
  int no = state && (fcntl(fileno(file), F_GETFL) & O_ACCMODE) != O_RDONLY && opened(fileno(file)) && refused("fclose");
  int done = real(file);
  return no ? (errno = ENOSPC, EOF) : done;
}
