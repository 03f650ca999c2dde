// The start of programs that are linked with the start files of glibc 2.34 or later, where the C library calls the
// constructors of a program, and run with an older one, where the program passes a function that does.
#pragma GCC visibility push(hidden)

typedef void function(int, char**, char**);
typedef int main_function(int, char**, char**);
extern function *__preinit_array_start[], *__preinit_array_end[], *__init_array_start[], *__init_array_end[];
extern void (*__fini_array_start[])(void), (*__fini_array_end[])(void);
extern void _init(void), _fini(void);

static void construct(int argc, char** argv, char** environment) {
  for (function** call = __preinit_array_start; call != __preinit_array_end; ++call) (*call)(argc, argv, environment);
  _init();
  for (function** call = __init_array_start; call != __init_array_end; ++call) (*call)(argc, argv, environment);
}

static void destroy(void) {
  for (void (**call)(void) = __fini_array_end; call != __fini_array_start;) (*--call)();
  _fini();
}

#pragma GCC visibility push(default)
int start_of_glibc(main_function*, int, char**, function*, void (*)(void), void (*)(void), void*);
#pragma GCC visibility pop
__asm__(".symver start_of_glibc, __libc_start_main@GLIBC_2.2.5");

int __libc_start_main(main_function* main, int argc, char** argv, function* init, void (*fini)(void),
                      void (*rtld_fini)(void), void* stack_end) {
  (void)init;
  (void)fini;
  return start_of_glibc(main, argc, argv, construct, destroy, rtld_fini, stack_end);
}

#pragma GCC visibility pop
