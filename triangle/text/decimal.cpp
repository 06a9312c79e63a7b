/* Conversion between numbers and text, based on charconv of the C++17 library; C has no equivalent.
 *
 * Reading uses std::from_chars (libstdc++ 12 or later: earlier versions call strtod). Printing has its own fast path,
 * because std::to_chars takes 85 ns for 17 digits: one 64 x 128 bit product with a tabulated power of ten yields the
 * digits, and an error bound shows whether they are correctly rounded. If this is not certain, the exact routine of the
 * library is used, so the fast path never prints a wrong digit. The scheme is that of Loitsch, "Printing floating-point
 * numbers quickly and accurately with integers" (PLDI 2010), reduced to 17 digits; the theorem is at
 * seventeen_digits. */
#include "triangle/text/decimal.h"

#include <cassert>
#include <charconv>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <system_error>

namespace {

const char digit_pairs[] = "00010203040506070809101112131415161718192021222324252627282930313233343536373839"
                           "40414243444546474849505152535455565758596061626364656667686970717273747576777879"
                           "8081828384858687888990919293949596979899";

void store_pair(char *at, uint32_t pair) { std::memcpy(at, digit_pairs + 2 * pair, 2); }

/* Stores eight digits, including leading zeros; n < 10^8. */
void store_eight(char *at, uint32_t n)
{
    const uint32_t high = n / 10000, low = n % 10000;
    store_pair(at, high / 100);
    store_pair(at + 2, high % 100);
    store_pair(at + 4, low / 100);
    store_pair(at + 6, low % 100);
}

/* Stores the digits of n without leading zeros, ending just before `end`. Returns their start. */
char *store_backwards(char *end, uint64_t n)
{
    while (n >= 100) {
        end -= 2;
        store_pair(end, static_cast<uint32_t>(n % 100));
        n /= 100;
    }
    if (n >= 10) {
        store_pair(end - 2, static_cast<uint32_t>(n));
        return end - 2;
    }
    end[-1] = static_cast<char>('0' + n);
    return end - 1;
}

int count_digits(uint64_t n)
{
    int digits = 1;
    for (; n >= 10000; n /= 10000)
        digits += 4;
    return digits + (n >= 10) + (n >= 100) + (n >= 1000);
}

char *print_unsigned(char *at, uint64_t n)
{
    char *const end = at + count_digits(n);
    store_backwards(end, n);
    return end;
}

/* libc++ before LLVM 20 has std::from_chars for integers only, and its std::to_chars adds 100 kB of tables. Apple's
 * libc++ is a part of macOS, and older versions of macOS lack both functions. */
#if defined(_LIBCPP_VERSION) && (_LIBCPP_VERSION < 200000 || defined(__apple_build_version__))
#define PTRIANGLE_NO_CHARCONV
#endif

/* Prints exactly; used whenever the fast path is not certain. */
char *print_exactly(char *at, double value)
{
#ifdef PTRIANGLE_NO_CHARCONV
    char *const end = at + std::snprintf(at, TRI_REAL_ROOM, "%.17g", value);
    if (char *const point = std::strchr(at, *std::localeconv()->decimal_point))
        *point = '.';
    return end;
#else
    return std::to_chars(at, at + TRI_REAL_ROOM, value, std::chars_format::general, 17).ptr;
#endif
}

#ifdef __SIZEOF_INT128__

__extension__ typedef unsigned __int128 wide;

/* 10^k lies in [g, g + 1 + 2^-100) * 2^(floor_log2_10(k) - 127) with 2^127 <= g = high * 2^64 + low < 2^128. */
struct power {
    uint64_t high, low;
};

constexpr int min_power = -292, max_power = 324;

/* floor(log2(10^k)); checked against the exact powers when the table is made. */
constexpr int floor_log2_10(int k) { return static_cast<int>((k * 1741647LL) >> 19); }

/* A 256-bit mantissa with its top bit set; limbs start with the least significant. */
struct mantissa {
    uint64_t limb[4];
    int log2; /* floor(log2(value)) */
};

constexpr mantissa shifted_left(mantissa x)
{
    for (int i = 3; i > 0; i--)
        x.limb[i] = x.limb[i] << 1 | x.limb[i - 1] >> 63;
    x.limb[0] <<= 1;
    x.log2--;
    return x;
}

/* Returns x * 10, truncated. The product is shifted right by three or four bits, which are added to the exponent. */
constexpr mantissa times_ten(const mantissa &x)
{
    uint64_t product[5] = {};
    wide carry = 0;
    for (int i = 0; i < 4; i++) {
        carry += static_cast<wide>(x.limb[i]) * 10;
        product[i] = static_cast<uint64_t>(carry);
        carry >>= 64;
    }
    product[4] = static_cast<uint64_t>(carry);
    const int shift = product[4] >= 8 ? 4 : 3;
    mantissa y = {{}, x.log2 + shift};
    for (int i = 0; i < 4; i++)
        y.limb[i] = product[i] >> shift | product[i + 1] << (64 - shift);
    return y;
}

/* Returns x / 10, truncated. */
constexpr mantissa over_ten(const mantissa &x)
{
    mantissa y = {{}, x.log2};
    wide rest = 0;
    for (int i = 3; i >= 0; i--) {
        rest = rest << 64 | x.limb[i];
        y.limb[i] = static_cast<uint64_t>(rest / 10);
        rest %= 10;
    }
    while (y.limb[3] >> 63 == 0)
        y = shifted_left(y);
    return y;
}

struct power_table {
    power of[max_power - min_power + 1] = {};
    bool exponents_agree = true;
};

/* Computes the table. Each of the at most 324 steps truncates less than 2^-251 of the value: less than 2^-242 in total,
 * which is 2^-114 of g's last bit. */
constexpr power_table make_powers()
{
    power_table table;
    const mantissa one = {{0, 0, 0, 1ULL << 63}, 0};
    mantissa up = one, down = one;
    for (int k = 0; k <= max_power; k++, up = times_ten(up)) {
        table.of[k - min_power] = {up.limb[3], up.limb[2]};
        table.exponents_agree = table.exponents_agree && up.log2 == floor_log2_10(k);
    }
    for (int k = 0; k >= min_power; k--, down = over_ten(down)) {
        table.of[k - min_power] = {down.limb[3], down.limb[2]};
        table.exponents_agree = table.exponents_agree && down.log2 == floor_log2_10(k);
    }
    return table;
}

constexpr power_table powers = make_powers();
static_assert(powers.exponents_agree, "floor_log2_10 must be exact over the whole table");

constexpr uint64_t ten_16 = 10000000000000000, ten_17 = 100000000000000000;

struct scaled {
    uint64_t whole, fraction;
};

/* Returns m * 2^e * 10^k as a whole number and 64 bits of fraction f. Errors, with g from the table: truncating the
 * lower half of m * g loses less than 1, and the error of g makes it too small by less than m * (1 + 2^-100) / 2^64 <=
 * 1 + 2^-100, in units of 2^64. Such a unit is at most 1/8 of a bit of f, since the shift is at least 3. Truncating f
 * loses less than 1. So the true fraction lies in [f, f + 1.26). */
scaled scale(uint64_t m, int e, int k)
{
    const power &g = powers.of[k - min_power];
    const wide product = static_cast<wide>(m) * g.high + (static_cast<wide>(m) * g.low >> 64);
    const int shift = -(e + floor_log2_10(k) - 127) - 128;
    const uint64_t high = static_cast<uint64_t>(product >> 64), low = static_cast<uint64_t>(product);
    assert(shift >= 3 && shift <= 11);
    return {high >> shift, high << (64 - shift) | low >> shift};
}

struct decimal {
    uint64_t digits; /* seventeen digits: [10^16, 10^17); 0: undecided */
    int exponent;    /* value = d.dddd * 10^exponent */
};

/* Returns the digits of a normal value, given as a significand in [2^52, 2^53) times 2^(exponent - 52).
 *
 * Theorem: they are those of the correctly rounded value. The computed x = value * 10^k is too small by less than 1.26
 * * 2^-64 (scale). So its side of the midpoint between two integers is certain, unless its fraction f is 2^63 - 1 or
 * 2^63. In that case, which includes exact ties, the result is undecided. If x seems less than 10^17 but is not, it
 * rounds to 10^17 either way. */
decimal seventeen_digits(uint64_t significand, int exponent)
{
    const uint64_t m = significand << 11;
    const int e = exponent - 63;
    int ten = static_cast<int>((exponent * 315653LL) >> 20); /* log10(2): floor(log10(value)), or 1 less */
    scaled x = scale(m, e, 16 - ten);
    if (x.whole >= ten_17) {
        ten++;
        x = scale(m, e, 16 - ten);
    }
    assert(x.whole >= ten_16 - 1 && x.whole < ten_17);
    const uint64_t half = 1ULL << 63;
    if (x.fraction - (half - 1) <= 1)
        return {0, 0};
    const uint64_t digits = x.whole + (x.fraction >> 63);
    return digits == ten_17 ? decimal{ten_16, ten + 1} : decimal{digits, ten};
}

/* Returns how many of the 17 digits remain without trailing zeros. */
size_t significant(const char *digits)
{
    size_t n = 17;
    while (digits[n - 1] == '0')
        n--;
    return n;
}

char *print_exponent(char *at, int exponent)
{
    *at++ = 'e';
    *at++ = exponent < 0 ? '-' : '+';
    const uint32_t size = static_cast<uint32_t>(exponent < 0 ? -exponent : exponent);
    if (size >= 100)
        *at++ = static_cast<char>('0' + size / 100);
    store_pair(at, size % 100);
    return at + 2;
}

/* Formats the digits like %g. Copies have a fixed length, hence TRI_REAL_ROOM. */
char *print_decimal(char *at, const decimal &d)
{
    char digits[24] = {};
    const uint64_t rest = d.digits % ten_16;
    digits[0] = static_cast<char>('0' + d.digits / ten_16);
    store_eight(digits + 1, static_cast<uint32_t>(rest / 100000000));
    store_eight(digits + 9, static_cast<uint32_t>(rest % 100000000));
    const size_t n = significant(digits);
    if (d.exponent >= 0 && d.exponent < 17) {
        const size_t whole = static_cast<size_t>(d.exponent) + 1;
        std::memcpy(at, digits, 17);
        if (n <= whole)
            return at + whole;
        at[whole] = '.';
        if (whole <= 8)
            std::memcpy(at + whole + 1, digits + whole, 16);
        else
            std::memcpy(at + whole + 1, digits + whole, 8);
        return at + n + 1;
    }
    if (d.exponent >= -4 && d.exponent < 0) {
        std::memcpy(at, "0.000", 5);
        at += 1 - d.exponent;
        std::memcpy(at, digits, 17);
        return at + n;
    }
    at[0] = digits[0];
    at[1] = '.';
    std::memcpy(at + 2, digits + 1, 16);
    return print_exponent(n == 1 ? at + 1 : at + n + 1, d.exponent);
}

/* value > 0 */
char *print_positive(char *at, double value)
{
    uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    const int exponent = static_cast<int>(bits >> 52);
    if (exponent == 0 || exponent == 2047)
        return print_exactly(at, value);
    const uint64_t fraction = bits & ((1ULL << 52) - 1);
    const decimal d = seventeen_digits(1ULL << 52 | fraction, exponent - 1023);
    return d.digits == 0 ? print_exactly(at, value) : print_decimal(at, d);
}

#else

char *print_positive(char *at, double value) { return print_exactly(at, value); }

#endif

/* Result of std::from_chars or its replacement. */
struct scanned {
    const char *ptr;
    std::errc ec;
};

#ifdef PTRIANGLE_NO_CHARCONV

/* Uses strtod, which rounds correctly in the C libraries that come with libc++. strtod needs a final 0 and the decimal
 * point of the locale, so the number is copied. It skips blanks and accepts a +, unlike from_chars. Out of range it
 * returns an infinity or zero, as the callers would. */
scanned scan_double(const char *at, const char *end, double *value, bool hexadecimal)
{
    static const char of_numbers[] = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.+-()_";
    const size_t prefix = hexadecimal ? 2 : 0;
    char few[128] = "0x";
    size_t n = 0;
    while (at + n < end && at[n] && std::strchr(of_numbers, at[n]))
        n++;
    char *const text = prefix + n < sizeof few ? few : static_cast<char *>(std::malloc(prefix + n + 1));
    if (!text || n == 0 || *at == '+')
        return {at, std::errc::invalid_argument};
    std::memcpy(text, "0x", prefix);
    std::memcpy(text + prefix, at, n);
    text[prefix + n] = 0;
    if (char *const point = std::strchr(text, '.'))
        *point = *std::localeconv()->decimal_point;
    char *stop;
    const double x = std::strtod(text, &stop);
    const size_t read = static_cast<size_t>(stop - text);
    if (text != few)
        std::free(text);
    if (read <= prefix)
        return {at, std::errc::invalid_argument};
    *value = x;
    return {at + (read - prefix), std::errc()};
}

#else

scanned scan_double(const char *at, const char *end, double *value, bool hexadecimal)
{
    const auto format = hexadecimal ? std::chars_format::hex : std::chars_format::general;
    const auto result = std::from_chars(at, end, *value, format);
    return {result.ptr, result.ec};
}

#endif

int digit_value(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : 99;
}

bool is_hexadecimal(const char *at, const char *end)
{
    return end - at > 2 && at[0] == '0' && (at[1] | 0x20) == 'x' && digit_value(at[2]) < 16;
}

/* Decides whether a decimal number out of range is too large or too small, which from_chars does not report. This is
 * the sign of the sum of its exponent and the position of its first significant digit. */
bool is_too_large(const char *at, const char *end)
{
    int64_t position = 0, exponent = 0;
    bool significant_seen = false, point_seen = false;
    for (; at < end && (*at | 0x20) != 'e'; at++) {
        significant_seen = significant_seen || (*at >= '1' && *at <= '9');
        if (*at == '.')
            point_seen = true;
        else if (significant_seen && !point_seen)
            position++;
        else if (!significant_seen && point_seen)
            position--;
    }
    if (at < end)
        tri_scan_integer(at + 1, end, &exponent);
    const int64_t limit = std::numeric_limits<int64_t>::max() / 2;
    return exponent > limit || (exponent > -limit && position + exponent > 0);
}

const char *scan_hexadecimal(const char *at, const char *end, double *value)
{
    const scanned result = scan_double(at, end, value, true);
    if (result.ec == std::errc::result_out_of_range) {
        const char *p = at;
        while (p < result.ptr && (*p | 0x20) != 'p')
            p++;
        const bool is_small = result.ptr - p > 1 && p[1] == '-';
        *value = is_small ? 0.0 : std::numeric_limits<double>::infinity();
    }
    return result.ptr;
}

/* Reads the number after the sign. */
const char *scan_unsigned_real(const char *at, const char *end, double *value)
{
    if (is_hexadecimal(at, end))
        return scan_hexadecimal(at + 2, end, value);
    const scanned result = scan_double(at, end, value, false);
    if (result.ec == std::errc::result_out_of_range)
        *value = is_too_large(at, result.ptr) ? std::numeric_limits<double>::infinity() : 0.0;
    return result.ptr;
}

/* Appends a digit, base <= 16; saturates at the largest value. */
uint64_t with_digit(uint64_t value, uint64_t base, uint64_t digit)
{
    if (value < 1ULL << 60) /* by far the most common case; needs no division */
        return value * base + digit;
    const uint64_t limit = std::numeric_limits<uint64_t>::max();
    return value > (limit - digit) / base ? limit : value * base + digit;
}

/* Returns the nearest int64_t for a sign and an absolute value. */
int64_t with_sign(uint64_t size, bool negative)
{
    const uint64_t limit = static_cast<uint64_t>(std::numeric_limits<int64_t>::max());
    if (size > limit)
        return negative ? std::numeric_limits<int64_t>::min() : std::numeric_limits<int64_t>::max();
    return negative ? -static_cast<int64_t>(size) : static_cast<int64_t>(size);
}

} /* namespace */

char *tri_print_real(char *at, double value)
{
    uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    *at = '-';
    at += bits >> 63;
    const double size = bits >> 63 ? -value : value;
    if (size < 9007199254740992.0 && static_cast<double>(static_cast<uint64_t>(size)) == size)
        return print_unsigned(at, static_cast<uint64_t>(size));
    return print_positive(at, size);
}

char *tri_print_integer(char *at, int64_t value, int width)
{
    const bool is_negative = value < 0;
    const uint64_t size = is_negative ? 0 - static_cast<uint64_t>(value) : static_cast<uint64_t>(value);
    const int digits = count_digits(size);
    for (int i = digits + is_negative; i < width; i++)
        *at++ = ' ';
    if (is_negative)
        *at++ = '-';
    store_backwards(at + digits, size);
    return at + digits;
}

const char *tri_scan_real(const char *at, const char *end, double *value)
{
    *value = 0;
    if (at == end)
        return at;
    if (*at != '-' && *at != '+')
        return scan_unsigned_real(at, end, value);
    if (end - at < 2 || at[1] == '-') /* from_chars would accept a second sign */
        return at;
    const char *const stop = scan_unsigned_real(at + 1, end, value);
    if (*at == '-')
        *value = -*value;
    return stop == at + 1 ? at : stop;
}

const char *tri_scan_integer(const char *at, const char *end, int64_t *value)
{
    const char *p = at;
    const bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+'))
        p++;
    const int base = is_hexadecimal(p, end) ? 16 : 10;
    if (base == 16)
        p += 2;
    const char *const digits = p;
    uint64_t size = 0;
    for (; p < end && digit_value(*p) < base; p++)
        size = with_digit(size, static_cast<uint64_t>(base), static_cast<uint64_t>(digit_value(*p)));
    *value = with_sign(size, negative);
    return p > digits ? p : at;
}
