#include <swing.h>

int main(void) {
    return swing_version() > 0 ? 0 : 1;
}
