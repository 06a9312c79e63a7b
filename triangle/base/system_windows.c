/* Windows 10 or newer. Names are UTF-8, with '/' or '\' between folders and ':' after a drive letter.
 *
 * Every file is opened so that other programs may read, write, rename and remove it meanwhile, as on POSIX. Owners are
 * not checked, because access control lists protect files. Interrupts run in threads of their own, so no function here
 * ends with EINTR. */
#define WIN32_LEAN_AND_MEAN
#define _WIN32_WINNT 0x0A00
#include <windows.h>

#include "triangle/base/system.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SHARE = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
    WIDE = TRI_PATH + 8, /* of a path in UTF-16, including the prefix before its root */
    LOOK = FILE_READ_ATTRIBUTES
};

/* --- errors and names */

static int errno_of(DWORD code)
{
    static const struct {
        DWORD code;
        int fault;
    } faults[] = {
        {ERROR_FILE_NOT_FOUND, ENOENT},      {ERROR_PATH_NOT_FOUND, ENOENT},     {ERROR_INVALID_NAME, ENOENT},
        {ERROR_INVALID_DRIVE, ENOENT},       {ERROR_BAD_NETPATH, ENOENT},        {ERROR_BAD_NET_NAME, ENOENT},
        {ERROR_BAD_PATHNAME, ENOENT},        {ERROR_NOT_READY, ENOENT},          {ERROR_TOO_MANY_OPEN_FILES, EMFILE},
        {ERROR_ACCESS_DENIED, EACCES},       {ERROR_SHARING_VIOLATION, EACCES},  {ERROR_WRITE_PROTECT, EROFS},
        {ERROR_LOCK_VIOLATION, EACCES},      {ERROR_NOT_ENOUGH_MEMORY, ENOMEM},  {ERROR_COMMITMENT_LIMIT, ENOMEM},
        {ERROR_OUTOFMEMORY, ENOMEM},         {ERROR_FILE_EXISTS, EEXIST},        {ERROR_ALREADY_EXISTS, EEXIST},
        {ERROR_DIR_NOT_EMPTY, ENOTEMPTY},    {ERROR_DIRECTORY, ENOTDIR},         {ERROR_HANDLE_DISK_FULL, ENOSPC},
        {ERROR_DISK_FULL, ENOSPC},           {ERROR_FILE_TOO_LARGE, EFBIG},      {ERROR_NOT_SUPPORTED, ENOSYS},
        {ERROR_INVALID_FUNCTION, ENOSYS},    {ERROR_BROKEN_PIPE, EPIPE},         {ERROR_NO_DATA, EPIPE},
        {ERROR_FILENAME_EXCED_RANGE, ENAMETOOLONG}, {ERROR_CANT_RESOLVE_FILENAME, ELOOP}};
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++)
        if (faults[i].code == code)
            return faults[i].fault;
    return EIO;
}

/* Sets errno from the last Windows error and returns false. */
static bool fail(void)
{
    errno = errno_of(GetLastError());
    return false;
}

static bool fail_by(int fault)
{
    errno = fault;
    return false;
}

static HANDLE handle_of(tri_file file) { return (HANDLE)file; }

static bool to_wide(const char *path, wchar_t wide[WIDE])
{
    if (strcmp(path, "/dev/null") == 0)
        path = "NUL";
    if (MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, TRI_PATH) > 0)
        return true;
    return fail_by(GetLastError() == ERROR_INSUFFICIENT_BUFFER ? ENAMETOOLONG : ENOENT);
}

static bool to_utf8(const wchar_t *wide, char path[TRI_PATH])
{
    return WideCharToMultiByte(CP_UTF8, 0, wide, -1, path, TRI_PATH, NULL, NULL) > 0 || fail_by(ENAMETOOLONG);
}

static tri_file open_wide(const wchar_t *path, DWORD access, DWORD way, DWORD flags)
{
    const HANDLE file = CreateFileW(path, access, SHARE, NULL, way, flags | FILE_FLAG_BACKUP_SEMANTICS, NULL);
    if (file == INVALID_HANDLE_VALUE)
        (void)fail();
    return (tri_file)file;
}

static tri_file open_path(const char *path, DWORD access, DWORD way, DWORD flags)
{
    wchar_t wide[WIDE];
    return to_wide(path, wide) ? open_wide(wide, access, way, flags) : TRI_NO_FILE;
}

/* Closes a file that must not be used and sets errno to `why`. */
static tri_file close_with_error(tri_file file, int why)
{
    (void)tri_file_close(file);
    errno = why;
    return TRI_NO_FILE;
}

/* --- files */

static const DWORD given[] = {STD_INPUT_HANDLE, STD_OUTPUT_HANDLE, STD_ERROR_HANDLE};

/* Returns stdin, stdout or stderr if this is its name on Linux, otherwise TRI_NO_FILE. */
static tri_file std_handle(const char *path)
{
    static const char *const names[] = {"in", "out", "err"};
    for (int i = 0; i < 3; i++)
        if (strncmp(path, "/dev/std", 8) == 0 && strcmp(path + 8, names[i]) == 0)
            return (tri_file)GetStdHandle(given[i]);
    return TRI_NO_FILE;
}

static bool is_standard(tri_file file)
{
    return file == (tri_file)GetStdHandle(given[0]) || file == (tri_file)GetStdHandle(given[1]) ||
           file == (tri_file)GetStdHandle(given[2]);
}

tri_file tri_file_open(const char *path, enum tri_opening opening)
{
    static const DWORD access[] = {
        [TRI_OPEN_READ] = GENERIC_READ, [TRI_OPEN_NO_WAIT] = GENERIC_READ, [TRI_OPEN_DEVICE] = GENERIC_WRITE,
        [TRI_OPEN_WRITE_SHARED] = GENERIC_WRITE, [TRI_OPEN_NEW] = GENERIC_READ | GENERIC_WRITE};
    const tri_file here = std_handle(path);
    return here != TRI_NO_FILE ? here
                               : open_path(path, access[opening], opening == TRI_OPEN_NEW ? CREATE_NEW : OPEN_EXISTING,
                                           opening == TRI_OPEN_WRITE_SHARED ? FILE_FLAG_OPEN_REPARSE_POINT : 0);
}

bool tri_file_close(tri_file file)
{
    return file == TRI_NO_FILE || is_standard(file) || CloseHandle(handle_of(file)) || fail();
}

/* Standard streams count as having no offsets, regardless of their target. */
bool tri_file_get_facts(tri_file file, struct tri_file_facts *facts)
{
    const DWORD type = GetFileType(handle_of(file));
    BY_HANDLE_FILE_INFORMATION at;
    FILE_STANDARD_INFO more;
    *facts = (struct tri_file_facts){.kind = TRI_OTHER_FILE, .names = 1, .permissions = 0666, .node = (uint64_t)file};
    if (type != FILE_TYPE_DISK)
        return type != FILE_TYPE_UNKNOWN || GetLastError() == NO_ERROR || fail();
    if (!GetFileInformationByHandle(handle_of(file), &at) ||
        !GetFileInformationByHandleEx(handle_of(file), FileStandardInfo, &more, sizeof more))
        return fail();
    facts->device = at.dwVolumeSerialNumber;
    facts->node = (uint64_t)at.nFileIndexHigh << 32 | at.nFileIndexLow;
    facts->size = (uint64_t)at.nFileSizeHigh << 32 | at.nFileSizeLow;
    facts->names = more.DeletePending ? 0 : at.nNumberOfLinks;
    if (at.dwFileAttributes & FILE_ATTRIBUTE_READONLY)
        facts->permissions = 0444;
    if (!is_standard(file))
        facts->kind = at.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY ? TRI_FOLDER : TRI_REGULAR;
    return true;
}

bool tri_path_get_facts(const char *path, struct tri_file_facts *facts)
{
    const tri_file here = std_handle(path), file = here != TRI_NO_FILE ? here : open_path(path, LOOK, OPEN_EXISTING, 0);
    const bool known = file != TRI_NO_FILE && tri_file_get_facts(file, facts);
    const int fault = errno;
    (void)tri_file_close(file);
    errno = fault;
    return known;
}

/* A new file inherits its permissions from its folder. */
bool tri_file_set_permissions(tri_file file, const struct tri_file_facts *as)
{
    (void)file, (void)as;
    return true;
}

/* --- reading and writing */

static OVERLAPPED overlapped_at(uint64_t place)
{
    return (OVERLAPPED){.Offset = (DWORD)place, .OffsetHigh = (DWORD)(place >> 32)};
}

static DWORD piece_of(size_t n) { return n < (1u << 30) ? (DWORD)n : 1u << 30; }

static int64_t read_some(tri_file file, void *at, size_t n, OVERLAPPED *place)
{
    DWORD got = 0;
    if (ReadFile(handle_of(file), at, piece_of(n), &got, place) || GetLastError() == ERROR_HANDLE_EOF ||
        GetLastError() == ERROR_BROKEN_PIPE) /* both mean the end */
        return (int64_t)got;
    (void)fail();
    return -1;
}

static int64_t write_some(tri_file file, const void *at, size_t n, OVERLAPPED *place)
{
    DWORD put = 0;
    if (WriteFile(handle_of(file), at, piece_of(n), &put, place))
        return (int64_t)put;
    (void)fail();
    return -1;
}

int64_t tri_read_at(tri_file file, void *at, size_t n, uint64_t place)
{
    size_t done = 0;
    while (done < n) {
        OVERLAPPED there = overlapped_at(place + done);
        const int64_t got = read_some(file, (char *)at + done, n - done, &there);
        if (got < 0)
            return -1;
        if (got == 0)
            break;
        done += (size_t)got;
    }
    return (int64_t)done;
}

bool tri_write_at(tri_file file, const void *at, size_t n, uint64_t place)
{
    for (size_t done = 0; done < n;) {
        const int64_t put = tri_write_some(file, (const char *)at + done, n - done, place + done);
        if (put < 0)
            return false;
        done += (size_t)put;
    }
    return true;
}

int64_t tri_read_next(tri_file file, void *at, size_t n) { return read_some(file, at, n, NULL); }

int64_t tri_write_some(tri_file file, const void *at, size_t n, uint64_t place)
{
    OVERLAPPED there = overlapped_at(place);
    return write_some(file, at, n, &there);
}

int64_t tri_write_next(tri_file file, const void *at, size_t n) { return write_some(file, at, n, NULL); }

bool tri_file_set_size(tri_file file, uint64_t size)
{
    FILE_END_OF_FILE_INFO end = {.EndOfFile.QuadPart = (LONGLONG)size};
    return SetFileInformationByHandle(handle_of(file), FileEndOfFileInfo, &end, sizeof end) || fail();
}

/* Only handles that are open for writing can be flushed. Folders are not. */
bool tri_file_sync(tri_file file)
{
    if (FlushFileBuffers(handle_of(file)))
        return true;
    const DWORD code = GetLastError();
    return code == ERROR_ACCESS_DENIED || code == ERROR_INVALID_HANDLE || code == ERROR_INVALID_FUNCTION || fail();
}

void tri_file_start_sync(tri_file file, uint64_t place, uint64_t n) { (void)file, (void)place, (void)n; }
void tri_file_finish_sync(tri_file file, uint64_t place, uint64_t n) { (void)file, (void)place, (void)n; }

tri_file tri_file_direct(tri_file file)
{
    (void)file;
    return TRI_NO_FILE;
}

void *tri_page_alloc(size_t bytes) { return malloc(bytes); } /* free() cannot release aligned blocks */

struct tri_async *tri_async_start(tri_file file, const void *at, size_t n, uint64_t place)
{
    (void)file, (void)at, (void)n, (void)place;
    return NULL;
}

size_t tri_async_wait(struct tri_async *behind)
{
    (void)behind;
    return 0;
}

/* No other process can read or write locked bytes, so the lock covers one byte beyond the largest possible file. */
enum tri_lock tri_file_lock(tri_file file)
{
    OVERLAPPED last = overlapped_at(INT64_MAX - 1);
    if (LockFileEx(handle_of(file), LOCKFILE_EXCLUSIVE_LOCK | LOCKFILE_FAIL_IMMEDIATELY, 0, 1, 0, &last))
        return TRI_LOCKED;
    const DWORD code = GetLastError();
    return code == ERROR_LOCK_VIOLATION || code == ERROR_IO_PENDING ? TRI_LOCKED_BY_ANOTHER : TRI_NO_LOCKS;
}

bool tri_file_allows_shared_pages(tri_file file, const char *host)
{
    char here[TRI_PATH];
    (void)file;
    return tri_host_name(here, sizeof here) && strcmp(here, host) == 0;
}

/* Windows removes the file when its last handle is closed, also after a kill. Until then it has a name. */
tri_file tri_scratch_file(const char *folder)
{
    enum { MOST = 1000 };
    static atomic_uint next;
    char path[TRI_PATH];
    for (int i = 0; i < MOST; i++) {
        const int n = snprintf(path, sizeof path, "%s/ptriangle-%lx-%x.tmp", folder, GetCurrentProcessId(), next++);
        if (n < 0 || n >= TRI_PATH)
            return fail_by(ENAMETOOLONG) ? 0 : TRI_NO_FILE;
        const tri_file file = open_path(path, GENERIC_READ | GENERIC_WRITE | DELETE, CREATE_NEW,
                                        FILE_FLAG_DELETE_ON_CLOSE);
        if (file != TRI_NO_FILE || errno != EEXIST)
            return file;
    }
    return TRI_NO_FILE;
}

/* --- names of files */

/* Opens the path to find out. */
bool tri_path_allows(const char *path, enum tri_access allowed)
{
    static const DWORD access[] = {[TRI_THERE] = LOOK, [TRI_READABLE] = GENERIC_READ, [TRI_WRITABLE] = GENERIC_WRITE,
                                   [TRI_ACCEPTS_FILES] = FILE_ADD_FILE};
    const tri_file file = open_path(path, access[allowed], OPEN_EXISTING, 0);
    return file != TRI_NO_FILE && tri_file_close(file);
}

/* Also removes read-only files, as on POSIX. */
static bool remove_wide(const wchar_t *path)
{
    if (DeleteFileW(path))
        return true;
    if (GetLastError() == ERROR_ACCESS_DENIED && (GetFileAttributesW(path) & FILE_ATTRIBUTE_READONLY) &&
        SetFileAttributesW(path, FILE_ATTRIBUTE_NORMAL) && DeleteFileW(path))
        return true;
    return fail();
}

/* Retries, because virus scanners and indexers hold new files open for short times. */
static bool rename_wide(const wchar_t *from, const wchar_t *to)
{
    enum { TRIES = 10 }; /* one second in total */
    for (int i = 0;; i++) {
        if (MoveFileExW(from, to, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH))
            return true;
        const DWORD code = GetLastError();
        if (i == TRIES || (code != ERROR_ACCESS_DENIED && code != ERROR_SHARING_VIOLATION))
            return fail();
        Sleep(1u << i);
    }
}

bool tri_path_remove(const char *path)
{
    wchar_t wide[WIDE];
    return to_wide(path, wide) && remove_wide(wide);
}

bool tri_path_rename(const char *from, const char *to)
{
    wchar_t a[WIDE], b[WIDE];
    return to_wide(from, a) && to_wide(to, b) && rename_wide(a, b);
}

bool tri_path_link(const char *path, const char *second)
{
    wchar_t a[WIDE], b[WIDE];
    return to_wide(path, a) && to_wide(second, b) && (CreateHardLinkW(b, a, NULL) || fail());
}

static char *copy_of(const wchar_t *wide)
{
    char *path = malloc(TRI_PATH);
    if (!path)
        errno = ENOMEM;
    if (path && to_utf8(wide, path))
        return path;
    free(path);
    return NULL;
}

/* Stores the absolute path with links resolved, in the form for the longest names: "\\?\C:\..." */
static bool final_path(tri_file file, wchar_t wide[WIDE])
{
    const DWORD n = GetFinalPathNameByHandleW(handle_of(file), wide, WIDE, FILE_NAME_NORMALIZED);
    return n == 0 ? fail() : n < WIDE || fail_by(ENAMETOOLONG);
}

/* Returns the path in the usual form: "C:\...", "\\server\..." */
static wchar_t *plain_path(wchar_t *path)
{
    if (wcsncmp(path, L"\\\\?\\UNC\\", 8) == 0) {
        path[6] = L'\\';
        return path + 6;
    }
    return wcsncmp(path, L"\\\\?\\", 4) == 0 ? path + 4 : path;
}

char *tri_path_from_root(const char *path)
{
    wchar_t wide[WIDE];
    const tri_file file = open_path(path, LOOK, OPEN_EXISTING, 0);
    char *found = file != TRI_NO_FILE && final_path(file, wide) ? copy_of(plain_path(wide)) : NULL;
    const int fault = errno;
    (void)tri_file_close(file);
    errno = fault;
    return found;
}

/* Only administrators and users they trust can create links, so all links are followed. */
char *tri_path_resolve(const char *path)
{
    wchar_t wide[WIDE];
    if (!to_wide(path, wide))
        return NULL;
    const DWORD attributes = GetFileAttributesW(wide);
    const bool is_link = attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_REPARSE_POINT);
    return is_link ? tri_path_from_root(path) : copy_of(wide);
}

size_t tri_path_folder_length(const char *path)
{
    size_t n = path[0] && path[1] == ':' ? 2 : 0; /* drive letter and ':' */
    for (size_t i = n; path[i]; i++)
        if (path[i] == '/' || path[i] == '\\')
            n = i + 1;
    return n;
}

/* --- folders */

bool tri_folder_make(const char *path)
{
    wchar_t wide[WIDE];
    return to_wide(path, wide) && (CreateDirectoryW(wide, NULL) || fail());
}

bool tri_folder_remove(const char *path)
{
    wchar_t wide[WIDE];
    return to_wide(path, wide) && (RemoveDirectoryW(wide) || fail());
}

tri_file tri_folder_open(const char *path, bool own)
{
    struct tri_file_facts facts;
    const tri_file folder = open_path(path, FILE_LIST_DIRECTORY | LOOK, OPEN_EXISTING, 0);
    (void)own;
    if (folder == TRI_NO_FILE || (tri_file_get_facts(folder, &facts) && facts.kind == TRI_FOLDER))
        return folder;
    return close_with_error(folder, ENOTDIR);
}

/* Stores the path of a file in the folder, at the folder's current place. */
static bool path_in(tri_file folder, const char *name, wchar_t path[WIDE])
{
    wchar_t last[WIDE];
    if (!final_path(folder, path) || !to_wide(name, last))
        return false;
    const size_t n = wcslen(path), m = wcslen(last);
    if (n + m + 2 > WIDE)
        return fail_by(ENAMETOOLONG);
    path[n] = L'\\';
    memcpy(path + n + 1, last, (m + 1) * sizeof *last);
    return true;
}

static tri_file open_in(tri_file folder, const char *name, DWORD access, DWORD way)
{
    wchar_t path[WIDE];
    return path_in(folder, name, path) ? open_wide(path, access, way, FILE_FLAG_OPEN_REPARSE_POINT) : TRI_NO_FILE;
}

tri_file tri_folder_file(tri_file folder, const char *name, enum tri_folder_opening opening)
{
    const DWORD access = opening == TRI_FOLDER_READ ? GENERIC_READ : GENERIC_READ | GENERIC_WRITE;
    const tri_file file = open_in(folder, name, access, opening == TRI_FOLDER_EXTEND ? OPEN_ALWAYS : OPEN_EXISTING);
    struct tri_file_facts facts;
    FILE_ATTRIBUTE_TAG_INFO tag;
    if (file == TRI_NO_FILE)
        return TRI_NO_FILE;
    if (!tri_file_get_facts(file, &facts) ||
        !GetFileInformationByHandleEx(handle_of(file), FileAttributeTagInfo, &tag, sizeof tag))
        return close_with_error(file, EIO);
    const bool is_link = tag.FileAttributes & FILE_ATTRIBUTE_REPARSE_POINT;
    const bool alone = opening != TRI_FOLDER_EXTEND || facts.names <= 1;
    return facts.kind == TRI_REGULAR && !is_link && alone ? file : close_with_error(file, EPERM);
}

tri_file tri_folder_create(tri_file folder, const char *name)
{
    if (!tri_folder_unlink(folder, name) && errno != ENOENT)
        return TRI_NO_FILE;
    return open_in(folder, name, GENERIC_WRITE, CREATE_NEW);
}

bool tri_folder_commit(tri_file folder, const char *name, tri_file file)
{
    (void)folder, (void)name;
    return tri_file_sync(file);
}

bool tri_folder_has(tri_file folder, const char *name)
{
    wchar_t path[WIDE];
    return path_in(folder, name, path) && (GetFileAttributesW(path) != INVALID_FILE_ATTRIBUTES || fail());
}

bool tri_folder_unlink(tri_file folder, const char *name)
{
    wchar_t path[WIDE];
    return path_in(folder, name, path) && remove_wide(path);
}

bool tri_folder_rename(tri_file folder, const char *from, const char *to)
{
    wchar_t a[WIDE], b[WIDE];
    return path_in(folder, from, a) && path_in(folder, to, b) && rename_wide(a, b);
}

bool tri_folder_list(tri_file folder, bool (*each)(void *user, const char *name), void *user)
{
    wchar_t path[WIDE];
    char name[TRI_PATH];
    WIN32_FIND_DATAW found;
    HANDLE list = path_in(folder, "*", path) ? FindFirstFileW(path, &found) : INVALID_HANDLE_VALUE;
    if (list == INVALID_HANDLE_VALUE)
        return fail();
    while (to_utf8(found.cFileName, name) && each(user, name) && FindNextFileW(list, &found))
        ;
    FindClose(list);
    return true;
}

/* --- mapped files */

/* Disk space is allocated when a file grows. */
int tri_file_reserve(tri_file file, uint64_t from, uint64_t size)
{
    (void)from;
    return tri_file_set_size(file, size) ? 0 : errno;
}

void *tri_file_map(tri_file file, size_t size)
{
    const HANDLE map = CreateFileMappingW(handle_of(file), NULL, PAGE_READWRITE, (DWORD)((uint64_t)size >> 32),
                                          (DWORD)size, NULL);
    void *at = map ? MapViewOfFile(map, FILE_MAP_READ | FILE_MAP_WRITE, 0, 0, size) : NULL;
    if (!at)
        (void)fail();
    if (map)
        CloseHandle(map); /* the view keeps the mapping */
    return at;
}

void tri_file_unmap(void *at, size_t size)
{
    (void)size;
    UnmapViewOfFile(at);
}

/* Unlocking pages that are not locked removes them from the working set. */
void tri_file_release_pages(void *at, size_t size) { (void)VirtualUnlock(at, size); }
