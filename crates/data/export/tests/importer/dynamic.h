/* Shared libraries as Windows and others load them. */
#ifndef SISTERSHIP_DYNAMIC_H
#define SISTERSHIP_DYNAMIC_H

#include <stdio.h>
#include <stdlib.h>

#ifdef _WIN32
#include <windows.h>

static void *loaded(const char *path)
{
    void *library = LoadLibraryA(path);
    if (!library)
        fprintf(stderr, "%s: error %lu\n", path, GetLastError());
    return library;
}

static void *symbol(void *library, const char *name)
{
    return (void *)GetProcAddress(library, name);
}
#else
#include <dlfcn.h>

static void *loaded(const char *path)
{
    void *library = dlopen(path, RTLD_NOW);
    if (!library)
        fprintf(stderr, "%s\n", dlerror());
    return library;
}

static void *symbol(void *library, const char *name)
{
    return dlsym(library, name);
}
#endif

static void *found(void *library, const char *name)
{
    void *function = symbol(library, name);
    if (!function) {
        fprintf(stderr, "no %s\n", name);
        exit(3);
    }
    return function;
}

#define FIND(name) name##TYPE *name##_ = (name##TYPE *)found(library, #name)

#endif
