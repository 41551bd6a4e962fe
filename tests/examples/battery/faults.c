/* Faults for a process: it is killed, or told of a full disk, at the k-th operation that changes a file or goes to a
 * socket; and its wall clock may run ahead. Loaded with LD_PRELOAD; steered through the shared file FAULTS_CONTROL. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

/* As `faults.rs` writes it. */
struct control {
    int64_t countdown; /* operations until the fault; it strikes where it passes from 1 to 0 */
    int64_t action;    /* 0 none, 1 kill, 2 no space from then on */
    int64_t counted;   /* operations so far */
    int64_t ahead_s;   /* seconds that the wall clock is ahead */
};

static struct control *control;

__attribute__((constructor)) static void begin(void) {
    const char *path = getenv("FAULTS_CONTROL");
    int fd = path ? open(path, O_RDWR) : -1;
    if (fd < 0) return;
    void *at = mmap(NULL, sizeof(struct control), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    close(fd);
    if (at != MAP_FAILED) control = at;
}

/* The error that the operation shall give, or 0. */
static int strike(int on_file) {
    if (!control) return 0;
    __atomic_fetch_add(&control->counted, 1, __ATOMIC_SEQ_CST);
    int64_t action = __atomic_load_n(&control->action, __ATOMIC_SEQ_CST);
    if (action == 0) return 0;
    int64_t before = __atomic_fetch_sub(&control->countdown, 1, __ATOMIC_SEQ_CST);
    if (action == 1 && before == 1) kill(getpid(), SIGKILL), pause();
    if (action == 2 && before <= 1 && on_file) return ENOSPC;
    return 0;
}

static int on_descriptor(int fd) {
    struct stat about;
    if (!control || fd <= 2 || fstat(fd, &about) != 0) return 0;
    if (S_ISREG(about.st_mode)) return strike(1);
    return S_ISSOCK(about.st_mode) ? strike(0) : 0;
}

#define REAL(name) __typeof__(&name) real = (__typeof__(&name))dlsym(RTLD_NEXT, #name)
#define OR_FAIL(error) do { int e = (error); if (e) { errno = e; return -1; } } while (0)

ssize_t write(int fd, const void *b, size_t n) { REAL(write); OR_FAIL(on_descriptor(fd)); return real(fd, b, n); }
ssize_t pwrite(int fd, const void *b, size_t n, off_t o) { REAL(pwrite); OR_FAIL(on_descriptor(fd)); return real(fd, b, n, o); }
ssize_t pwrite64(int fd, const void *b, size_t n, off64_t o) { REAL(pwrite64); OR_FAIL(on_descriptor(fd)); return real(fd, b, n, o); }
ssize_t writev(int fd, const struct iovec *v, int n) { REAL(writev); OR_FAIL(on_descriptor(fd)); return real(fd, v, n); }
ssize_t send(int fd, const void *b, size_t n, int f) { REAL(send); OR_FAIL(on_descriptor(fd)); return real(fd, b, n, f); }
ssize_t sendmsg(int fd, const struct msghdr *m, int f) { REAL(sendmsg); OR_FAIL(on_descriptor(fd)); return real(fd, m, f); }
int fsync(int fd) { REAL(fsync); OR_FAIL(strike(1)); return real(fd); }
int fdatasync(int fd) { REAL(fdatasync); OR_FAIL(strike(1)); return real(fd); }
int ftruncate(int fd, off_t n) { REAL(ftruncate); OR_FAIL(strike(1)); return real(fd, n); }
int ftruncate64(int fd, off64_t n) { REAL(ftruncate64); OR_FAIL(strike(1)); return real(fd, n); }
int rename(const char *a, const char *b) { REAL(rename); OR_FAIL(strike(1)); return real(a, b); }
int link(const char *a, const char *b) { REAL(link); OR_FAIL(strike(1)); return real(a, b); }
int linkat(int c, const char *a, int d, const char *b, int f) { REAL(linkat); OR_FAIL(strike(1)); return real(c, a, d, b, f); }
int mkdir(const char *a, mode_t m) { REAL(mkdir); OR_FAIL(strike(1)); return real(a, m); }

/* A full disk still lets a file be removed. */
int unlink(const char *a) { REAL(unlink); strike(0); return real(a); }

int clock_gettime(clockid_t id, struct timespec *now) {
    REAL(clock_gettime);
    int answer = real(id, now);
    if (answer == 0 && id == CLOCK_REALTIME && control) now->tv_sec += __atomic_load_n(&control->ahead_s, __ATOMIC_SEQ_CST);
    return answer;
}
