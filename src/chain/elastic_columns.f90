!> The columns of elastic members: shapes of the rod and twist of the crankshaft.
module elastic_columns
  use trace_row, only: trace_row_t, largest, largest_size
  use chain_motion, only: motion_t, accelerations_t
  use elastic_rod, only: elastic_rod_t
  use elastic_members, only: elastic_members_t
  implicit none
  private
  public :: add_elastic_columns

contains

  !> Add the columns of elastic members to a row. Rates and accelerations of the rod's shapes, and the flywheel's acceleration,
  !> are written only on request.
  pure subroutine add_elastic_columns(elastic, motion, accelerations, row)
    type(elastic_members_t), intent(in) :: elastic
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(trace_row_t), intent(inout) :: row
    integer :: i
    if (allocated(elastic%rod)) then
      associate (rod => elastic%rod)
        do i = 1, rod%n_bending + rod%n_axial
          call row%add(trim(shape_name(rod, i))//'[m]', motion%shape(i), trim(shape_meaning(rod, i)))
          if (i == rod%n_bending + 1) call row%keep('max_rod_stretch', largest_size, &
            'largest elongation or shortening of the rod', rate=motion%shape_rate(i))
        end do
        call row%add('rod_mid_deflection[m]', rod%mid_deflection(motion%shape), &
          'bending deflection of the rod midway between its pins')
        call row%keep('max_rod_mid_deflection', largest_size, 'largest bending deflection of the rod midway between its pins', &
          rate=rod%mid_deflection(motion%shape_rate))
        call row%add('rod_strain_energy[J]', rod%strain_energy(motion), 'elastic energy stored in the rod')
        call row%keep('max_rod_strain_energy', largest, 'largest elastic energy in the rod', &
          rate=sum(rod%stiffness(:rod%n)*motion%shape(:rod%n)*motion%shape_rate(:rod%n)))
        if (row%is_naming .or. row%wants(2*(rod%n_bending + rod%n_axial))) then
          do i = 1, rod%n_bending + rod%n_axial
            call row%add_on_request(trim(shape_name(rod, i))//'_rate[m/s]', motion%shape_rate(i), &
              'time derivative of '//trim(shape_name(rod, i)))
            call row%add_on_request(trim(shape_name(rod, i))//'_acceleration[m/s2]', accelerations%shape(i), &
              'second time derivative of '//trim(shape_name(rod, i)))
          end do
        else
          call row%skip(2*(rod%n_bending + rod%n_axial))
        end if
      end associate
    end if
    if (.not. allocated(elastic%crankshaft)) return
    call row%add('crankshaft_twist[rad]', motion%flywheel_angle - motion%crank_angle, 'flywheel angle less crank angle')
    call row%keep('max_crankshaft_twist', largest_size, 'largest twist of the crankshaft', &
      rate=motion%flywheel_speed - motion%crank_speed)
    call row%add('crankshaft_moment[N.m]', elastic%crankshaft%moment(motion), 'moment of the elastic shaft on the crank')
    call row%add('flywheel_speed[rad/s]', motion%flywheel_speed, 'angular velocity of the flywheel')
    call row%add_on_request('flywheel_acceleration[rad/s2]', accelerations%flywheel, 'angular acceleration of the flywheel')
  end subroutine add_elastic_columns

  !> The name of a shape's column.
  pure function shape_name(rod, i) result(name)
    type(elastic_rod_t), intent(in) :: rod
    integer, intent(in) :: i   !! index of the shape; bending shapes come first
    character(len=11) :: name
    if (i <= rod%n_bending) then
      name = 'rod_mode_'//achar(iachar('0') + i)
    else if (i == rod%n_bending + 1) then
      name = 'rod_stretch'
    else
      name = 'rod_axial_'//achar(iachar('0') + i - rod%n_bending)
    end if
  end function shape_name

  pure function shape_meaning(rod, i) result(text)
    type(elastic_rod_t), intent(in) :: rod
    integer, intent(in) :: i
    character(len=44) :: text
    text = 'amplitude of this axial shape of the rod'
    if (i <= rod%n_bending) text = 'amplitude of this transverse mode of the rod'
    if (i == rod%n_bending + 1) text = 'elongation of the rod between its pins'
  end function shape_meaning
end module elastic_columns
