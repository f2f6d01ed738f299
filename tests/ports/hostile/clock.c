/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: protocol by `attest time`, except with HONEST. The C starter, but each step uses 3 ms of
 * CPU time more, and the port hides that. Compiled with one of these definitions:
 *
 *   HONEST  hides nothing: must be timed
 *   GOT     replaces clock_gettime() in the tables of the program and of its libraries
 *   CODE    replaces the code of clock_gettime() (x86-64 only; elsewhere the same as GOT)
 *   STACK   changes the time at which the step began, which its caller has on the stack
 *   THREAD  the same as GOT, and another thread does the work while the step sleeps */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <pthread.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include "../wrapper.h"

static const int64_t work_ns = 3000000;
static _Atomic int64_t hidden_ns;

/* By a system call, so not by a function that this port has replaced. */
static int64_t real_ns(clockid_t clock) {
  struct timespec now;
  syscall(SYS_clock_gettime, clock, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void* work(void* unused) {
  const int64_t begin = real_ns(CLOCK_THREAD_CPUTIME_ID);
  while (real_ns(CLOCK_THREAD_CPUTIME_ID) < begin + work_ns) {
  }
  return unused;
}

#if defined(GOT) || defined(CODE) || defined(THREAD)
static int slow_clock_gettime(clockid_t clock, struct timespec* now) {
  const int64_t shown = real_ns(clock) - hidden_ns;
  now->tv_sec = shown / 1000000000;
  now->tv_nsec = shown % 1000000000;
  return 0;
}

static void make_writable(void* place) {
  const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE);
  void* const begin = (void*)((uintptr_t)place & ~(page - 1)); /* NOLINT */
  mprotect(begin, 2 * page, PROT_READ | PROT_WRITE | PROT_EXEC);
}

#if defined(CODE) && defined(__x86_64__)
static void replace_clock(void) {
  unsigned char* const code = dlsym(RTLD_DEFAULT, "clock_gettime");
  unsigned char jump[] = {0x48, 0xb8, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xe0}; /* mov rax, N; jmp rax */
  int (*const to)(clockid_t, struct timespec*) = slow_clock_gettime;
  memcpy(jump + 2, &to, sizeof to);
  make_writable(code);
  memcpy(code, jump, sizeof jump);
}
#else
/* Replaces every pointer to the real function in the relocated tables of one file. */
static int replace_in(struct dl_phdr_info* file, size_t size, void* real) {
  (void)size;
  for (int i = 0; i < file->dlpi_phnum; i++) {
    const ElfW(Phdr)* const part = &file->dlpi_phdr[i];
    if (part->p_type != PT_GNU_RELRO && (part->p_type != PT_LOAD || !(part->p_flags & PF_W)))
      continue;
    void** const begin = (void**)(file->dlpi_addr + part->p_vaddr); /* NOLINT */
    for (size_t k = 0; k < part->p_memsz / sizeof *begin; k++) {
      if (begin[k] != real) continue;
      make_writable(&begin[k]);
      int (*const to)(clockid_t, struct timespec*) = slow_clock_gettime;
      memcpy(&begin[k], &to, sizeof to);
    }
  }
  return 0;
}

static void replace_clock(void) {
  dl_iterate_phdr(replace_in, dlsym(RTLD_DEFAULT, "clock_gettime"));
}
#endif
#endif

#ifdef STACK
/* The caller has read the clock just before the step. */
__attribute__((noinline, no_sanitize("address"))) static void change_callers(int64_t begin,
                                                                             int64_t end) {
  volatile int64_t* const frame = __builtin_frame_address(0);
  for (int i = 0; i < 200; i++) {
    if (frame[i] > begin - work_ns / 10 && frame[i] <= begin) frame[i] = end;
  }
}
#endif

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  const int64_t begin = real_ns(CLOCK_MONOTONIC);
#ifdef THREAD
  pthread_t thread;
  pthread_create(&thread, NULL, work, NULL);
  pthread_join(thread, NULL);
#else
  work(NULL);
#endif
  const int result = wrapper_step(self, in, out);
  const int64_t end = real_ns(CLOCK_MONOTONIC);
  hidden_ns += end - begin;
#ifdef STACK
  change_callers(begin, end);
#endif
  return result;
}

static void* create(const char* profile) {
#if defined(GOT) || defined(CODE) || defined(THREAD)
  static int replaced = 0;
  if (!replaced) replace_clock();
  replaced = 1;
#endif
  return wrapper_create(profile);
}

WRAPPER_UNIT("clock", create, step);
