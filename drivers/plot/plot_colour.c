/* Colours, chosen in Oklch (B. Ottosson, "A perceptual color space for image processing", 2020), where equal steps of
 * lightness L, chroma C and hue look equally large; then brought to sRGB, less colourful where the screen cannot. */
#include "drivers/plot/plot.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static double to_srgb(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

/* Linear light; components may lie outside 0 .. 1. */
static void oklch_to_linear(double L, double C, double hue, double rgb[3])
{
    const double a = C * cos(hue * pi / 180), b = C * sin(hue * pi / 180);
    const double l = pow(L + 0.3963377774 * a + 0.2158037573 * b, 3);
    const double m = pow(L - 0.1055613458 * a - 0.0638541728 * b, 3);
    const double s = pow(L - 0.0894841775 * a - 1.2914855480 * b, 3);
    rgb[0] = 4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s;
    rgb[1] = -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s;
    rgb[2] = -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s;
}

static bool on_screen(const double rgb[3])
{
    for (int k = 0; k < 3; k++) {
        if (rgb[k] < 0 || rgb[k] > 1)
            return false;
    }
    return true;
}

static double clamp(double x)
{
    return fmin(fmax(x, 0), 1);
}

static struct plot_colour from_oklch(double L, double C, double hue)
{
    double rgb[3];
    oklch_to_linear(L, C, hue, rgb);
    for (int tries = 0; tries < 60 && !on_screen(rgb); tries++) {
        C *= 0.95;
        oklch_to_linear(L, C, hue, rgb);
    }
    return (struct plot_colour){to_srgb(clamp(rgb[0])), to_srgb(clamp(rgb[1])), to_srgb(clamp(rgb[2]))};
}

struct plot_colour plot_colour_scale(double t)
{
    t = clamp(t);
    return from_oklch(0.30 + 0.63 * t, 0.12 + 0.05 * t, 310 - 205 * t);
}

/* Hues by the golden angle: each new one falls into the widest gap between those before it. */
struct plot_colour plot_colour_category(int category, double tone)
{
    static const double lightness[3] = {0, -0.17, 0.1};
    const double hue = fmod(250 + 137.50776405 * category, 360);
    return from_oklch(0.74 + lightness[category / 7 % 3] + 0.18 * (clamp(tone) - 0.5), 0.115, hue);
}
