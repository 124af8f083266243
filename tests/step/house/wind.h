/// @file wind.h
/// How strong the wind of test_house blows.
///
/// SPDX-License-Identifier: MIT
#ifndef HOUSE_WIND_H
#define HOUSE_WIND_H

extern float house_wind_force; ///< N; 0: there is no wind, and no stage of it

#endif
