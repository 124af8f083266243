#include "base/decay.h"

float mspringi_decay(float rate, float h) {
    double x = (double)rate * (double)h;
    if (x == 0.0)
        return 1.0f; // the result below, without the work
    // exp(-104) is below the smallest float.
    if (!(x < 104.0))
        return 0.0f;
    // exp(-x) = exp(-x / 2^n)^(2^n), with x / 2^n below 1/8, where the series to the 9th power is exact to double
    // precision: (1/8)^10 / 10! = 2.6e-16.
    int squarings = 0;
    while (x >= 0.125) {
        x *= 0.5;
        ++squarings;
    }
    double sum = 1.0;
    for (int power = 9; power >= 1; --power)
        sum = 1.0 - x / (double)power * sum;
    for (; squarings > 0; --squarings)
        sum *= sum;
    return (float)sum;
}

static double loss(double x) {
    if (x == 0.0)
        return 0.0; // the result below, without the work
    if (!(x < 0.125))
        return 1.0 - (double)mspringi_decay((float)x, 1.0f);
    double sum = 1.0; // x (1 - x/2 (1 - x/3 (...)))
    for (int power = 9; power >= 2; --power)
        sum = 1.0 - x / (double)power * sum;
    return x * sum;
}

float mspringi_loss(float rate, float h) {
    return (float)loss((double)rate * (double)h);
}

float mspringi_gain(float rate, float h) {
    return rate > 0.0f ? (float)(loss((double)rate * (double)h) / (double)rate) : h;
}

double mspringi_stability_bound(float rate, float h) {
    const double x = (double)rate * (double)h;
    return x > 0.0 ? 2.0 * (2.0 - loss(x)) * x / loss(x) : 4.0;
}
