/* What the host's board takes of a C library, where a page has none: the module then asks nothing of who loads it. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { PAGE = 65536, ALIGNED = 16 };

extern uint8_t __heap_base; /* where the linker's own things end */
static size_t taken;        /* bytes of memory, those included */

/* The page asks for room for what it hands over, too. Nothing is given back: memory ends with the module's instance. */
__attribute__((visibility("default"))) void *calloc(size_t count, size_t size)
{
    const size_t from = taken ? taken : (size_t)&__heap_base;
    const size_t at = (from + ALIGNED - 1) / ALIGNED * ALIGNED;
    const size_t there = __builtin_wasm_memory_size(0) * PAGE;
    taken = at + count * size;
    if (taken > there && __builtin_wasm_memory_grow(0, (taken - there + PAGE - 1) / PAGE) == SIZE_MAX) {
        return NULL;
    }
    return (void *)at;
}

void free(void *memory)
{
    (void)memory;
}

int memcmp(const void *left, const void *right, size_t count)
{
    const uint8_t *a = left, *b = right;
    for (; count; count--, a++, b++) {
        if (*a != *b) {
            return *a - *b;
        }
    }
    return 0;
}
