// Runs entries on an AArch64 processor: a program without libraries. Its input is rows of four
// numbers: what to do, and with what. Its memory begins at FIRST and has SIZE bytes, all 0.

typedef long word;
typedef void entry(word *result, word *error, word index, word address);

enum { READ = 63, WRITE = 64, EXIT = 93, MAP = 222 };  // of Linux
enum { CALL, PUT, GET };                               // what rows say
enum { READ_AND_WRITE = 3, HERE_AND_OWN = 0x32 };

extern entry *const ENTRIES[];

static word ask(word what, word a, word b, word c, word d, word e, word f) {
  register word x8 asm("x8") = what;
  register word x0 asm("x0") = a;
  register word x1 asm("x1") = b;
  register word x2 asm("x2") = c;
  register word x3 asm("x3") = d;
  register word x4 asm("x4") = e;
  register word x5 asm("x5") = f;
  asm volatile("svc 0" : "+r"(x0) : "r"(x8), "r"(x1), "r"(x2), "r"(x3), "r"(x4), "r"(x5) : "memory");
  return x0;
}

static void end(word status) { ask(EXIT, status, 0, 0, 0, 0, 0); }

// Read from file 0 or write to file 1: all bytes. The input may end before the first one.
static void pass(word what, word file, word address, word length) {
  for (word passed = 0; passed < length;) {
    word more = ask(what, file, address + passed, length - passed, 0, 0, 0);
    if (more <= 0) end(passed || more || what == WRITE);
    passed += more;
  }
}

void _start(void) {
  if (ask(MAP, FIRST, SIZE, READ_AND_WRITE, HERE_AND_OWN, -1, 0) != FIRST) end(2);
  for (;;) {
    word row[4], result, error;
    pass(READ, 0, (word)row, sizeof row);
    if (row[0] == CALL) ENTRIES[row[1]](&result, &error, row[2], row[3]);
    if (row[0] == PUT) pass(READ, 0, row[1], row[2]);
    if (row[0] == GET) pass(WRITE, 1, row[1], row[2]);
  }
}

// What compilers call, whether or not there is a library.
void *memcpy(void *target, const void *source, unsigned long count) {
  for (unsigned long at = 0; at < count; at++) ((char *)target)[at] = ((const char *)source)[at];
  return target;
}

void *memmove(void *target, const void *source, unsigned long count) {
  if (target <= source) return memcpy(target, source, count);
  while (count--) ((char *)target)[count] = ((const char *)source)[count];
  return target;
}

void *memset(void *target, int value, unsigned long count) {
  for (unsigned long at = 0; at < count; at++) ((char *)target)[at] = (char)value;
  return target;
}
