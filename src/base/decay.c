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
