!> The places of joints in the chain. A joint at a further place is a line in `places`.
module joint_places
  use kinds, only: dp
  use chain_motion, only: crank_pin, piston_pin, small_end, body_crank, body_big_end, body_small_end, body_piston, body_frame
  implicit none
  private
  public :: place_t, places, n_places, in_order, name_prefix, joint_group, crank_pin, piston_pin, small_end, main_bearing

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

contains

  !> Prefix of the names of a place's quantities.
  pure function name_prefix(place) result(prefix)
    integer, intent(in) :: place   !! index in `places`
    character(len=:), allocatable :: prefix
    prefix = trim(places(place)%prefix)
  end function name_prefix

  !> Name of the group of a place's joint in cases.
  pure function joint_group(place) result(group)
    integer, intent(in) :: place   !! index in `places`
    character(len=:), allocatable :: group
    group = 'joint'
    if (place /= in_order(1)) group = trim(places(place)%name)//'.joint'
  end function joint_group
end module joint_places
