!> The places of joints in the chain. A joint at a further place is a line in `places`.
!>
!> Of several cylinders on one crankshaft there are many main bearings and big ends. A spot is one bearing: a place itself, or one
!> of its numbered bearings, the main bearings along the shaft or the big ends of the cylinders.
module joint_places
  use kinds, only: dp
  use chain_motion, only: crank_pin, piston_pin, small_end, body_crank, body_big_end, body_small_end, body_piston, body_frame
  use train_motion, only: most_cylinders
  implicit none
  private
  public :: place_t, places, n_places, in_order, name_prefix, pin_title, joint_group, crank_pin, piston_pin, small_end, main_bearing
  public :: n_spots, spot_of, place_of, number_of, spot_prefix, spot_name, spot_title

  !> One place: its names, and how its joint enters the chain. The eccentricity of the pin in its bearing is that of the chain
  !> at this pin, the joint's force on its pin acts on the body nearer to the crank, and the opposite force on the other; the other
  !> way round if the pin belongs to the body farther from the crank.
  type :: place_t
    character(len=12) :: name      !! in cases and results
    character(len=13) :: prefix    !! of the names of its quantities
    character(len=12) :: title     !! in messages
    integer :: pin                 !! of the chain, where it enters: crank_pin or piston_pin; 0: it is ideal in the chain
    integer :: pin_body, bearing   !! bodies with which they turn: see chain_motion
    real(dp) :: sense              !! 1: the pin belongs to the body nearer to the crank; -1: to the other
  end type place_t

  integer, parameter :: n_places = 4
  integer, parameter :: main_bearing = 4   !! index of the crank's bearing in the frame
  type(place_t), parameter :: places(n_places) = [ &
    place_t('crank_pin', 'crank_pin_', 'crank pin', crank_pin, body_crank, body_big_end, 1.0_dp), &
    place_t('piston_pin', '', 'piston pin', piston_pin, body_small_end, body_piston, 1.0_dp), &
    place_t('small_end', 'small_end_', 'small end', piston_pin, body_piston, body_small_end, -1.0_dp), &
    place_t('main_bearing', 'main_bearing_', 'main bearing', 0, body_crank, body_frame, 1.0_dp)]

  integer, parameter :: in_order(n_places) = [piston_pin, small_end, crank_pin, main_bearing]   !! order in cases and results

  integer, parameter :: most_mains = most_cylinders + 1
  integer, parameter :: n_spots = n_places + most_mains + most_cylinders   !! the places, main bearings, big ends
  character(len=2), parameter :: digits(most_mains) = [character(len=2) :: '1', '2', '3', '4', '5', '6', '7', '8', '9', '10', &
    '11', '12', '13', '14', '15', '16', '17']

contains

  !> The spot of a bearing at a place; number 0: that of the place itself.
  pure integer function spot_of(place, number) result(spot)
    integer, intent(in) :: place    !! index in `places`; with a number a main bearing or a crank pin
    integer, intent(in) :: number   !! main bearing along the shaft, or cylinder
    spot = place
    if (number > 0) spot = n_places + number
    if (number > 0 .and. place == crank_pin) spot = spot + most_mains
  end function spot_of

  !> The place of a spot.
  elemental integer function place_of(spot) result(place)
    integer, intent(in) :: spot
    place = spot
    if (spot > n_places) place = main_bearing
    if (spot > n_places + most_mains) place = crank_pin
  end function place_of

  !> The number of the bearing of a spot; 0: it is a place itself.
  elemental integer function number_of(spot) result(number)
    integer, intent(in) :: spot
    number = max(0, spot - n_places)
    if (number > most_mains) number = number - most_mains
  end function number_of

  !> Prefix of the names of a spot's quantities: main_bearing_3_. Of one length, so that threads may call it at once.
  pure function spot_prefix(spot) result(prefix)
    integer, intent(in) :: spot
    character(len=16) :: prefix
    prefix = places(place_of(spot))%prefix
    if (spot > n_places) prefix = trim(prefix)//trim(digits(number_of(spot)))//'_'
  end function spot_prefix

  !> The same without blanks behind it.
  pure function name_prefix(spot) result(prefix)
    integer, intent(in) :: spot
    character(len=:), allocatable :: prefix
    prefix = trim(spot_prefix(spot))
  end function name_prefix

  !> Name of a spot in results: main_bearing_3.
  pure function spot_name(spot) result(name)
    integer, intent(in) :: spot
    character(len=:), allocatable :: name
    name = trim(places(place_of(spot))%name)
    if (spot > n_places) name = name//'_'//trim(digits(number_of(spot)))
  end function spot_name

  !> The bearing of a spot, in texts: main bearing 3.
  pure function spot_title(spot) result(title)
    integer, intent(in) :: spot
    character(len=:), allocatable :: title
    title = trim(places(place_of(spot))%title)
    if (spot > n_places) title = title//' '//trim(digits(number_of(spot)))
  end function spot_title

  !> The pin of a spot, in texts.
  pure function pin_title(spot) result(title)
    integer, intent(in) :: spot
    character(len=:), allocatable :: title
    title = spot_title(spot)
    if (spot == small_end) title = 'piston pin in the small end'
  end function pin_title

  !> Name of the group of a place's joint in cases.
  pure function joint_group(place) result(group)
    integer, intent(in) :: place   !! index in `places`
    character(len=:), allocatable :: group
    group = 'joint'
    if (place /= in_order(1)) group = trim(places(place)%name)//'.joint'
  end function joint_group
end module joint_places
